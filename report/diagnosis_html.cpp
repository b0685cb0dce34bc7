#include "report/diagnosis_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/detail/svg_chart.hpp"

namespace pelletlab::report {

namespace {

using detail::escaped;

constexpr const char* style =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:1080px;margin:2em auto;padding:0 "
    "1em;color:#1c2430}h1{font-size:1.5em;margin:0}h2{font-size:1.15em;margin:2em 0 .5em;"
    "border-bottom:1px solid #d5dbe3}table{border-collapse:collapse;margin:.5em 0}td,th{padding:.25em .8em;text-align:left;border-bottom:1px solid "
    "#e6eaf0;vertical-align:top}"
    "td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}.verdict{background:#10365c;color:#fff;padding:1em 1.2em;border-radius:8px}.verdict "
    "b{font-size:1.3em}.gap{color:#b3261e;"
    "font-weight:600}.soft{color:#5b6675}.row{display:flex;flex-wrap:wrap;gap:1em}svg{background:#fff}";

std::string number(double value, const char* format = "{:.3g}") {
    return std::isnan(value) ? "–" : fmt::format(fmt::runtime(format), value);
}

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
    std::string text = "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i) text += fmt::format("<{}{}>{}</{}>", tag, i == 0 ? "" : " class=n", cells[i], tag);
    return text + "</tr>";
}

std::string where_section(const Diagnosis& d) {
    std::string text =
        "<h2>Where</h2><p class=soft>Measured minus the best joint fit of the baseline, averaged over the group, with a 90 % interval. «GAP»: discovery at the "
        "false discovery rate of the experiment by the group's own data. «explained»: the gap that the weighed explanations of the next section predict there; "
        "all "
        "data speak for them, so they show gaps that a group alone cannot, and they are only as right as the explanation. The last column is the standardised "
        "miss when the fit does not see the group: it tells culprits from victims.</p><div class=row>";
    for (const DiagnosisCurve& c : d.curves)
        if (c.axis.size() > 1) text += detail::profile_chart(c);
    text += "</div><p class=soft>● measured (bars: ±2 uncertainties), — baseline, calibrated, - - with the leading explanation; red: the gap.</p><table>" +
            row({"group", "gap", "90 % interval", "p", "", "explained", "90 % interval", "", "left out: z"}, "th");
    for (const DiagnosisWhere& w : d.where)
        text += row({escaped(w.group), number(w.gap) + (w.unit == "1" ? "" : " " + escaped(w.unit)), number(w.lower) + " to " + number(w.upper),
                     number(w.p, "{:.4f}"), w.discovery ? "<span class=gap>GAP</span>" : "", number(w.explained),
                     number(w.explained_lower) + " to " + number(w.explained_upper), w.explained_discovery ? "<span class=gap>GAP</span>" : "",
                     number(w.left_out_z, "{:.1f}")});
    return text + "</table>";
}

std::string which_section(const Diagnosis& d) {
    std::string text = "<h2>Which</h2><div class=row>" + detail::probability_bars(d) + "</div><table>" +
                       row({"explanation", "probability", "ln evidence", "χ²", "amplitude (90 %)", "parameters (90 %)"}, "th");
    for (const DiagnosisHypothesis& h : d.hypotheses) {
        if (h.probability < 0.002) continue;
        std::string amplitude, parameters;
        for (const auto& a : h.amplitudes) amplitude += (amplitude.empty() ? "" : "<br>") + escaped(a.effect + " " + a.text);
        for (const auto& p : h.parameters) parameters += (parameters.empty() ? "" : "<br>") + escaped(p);
        text += row({escaped(h.name) + (h.in_set ? " *" : ""), number(h.probability, "{:.3f}"), number(h.log_evidence, "{:.1f}"), number(h.chi2), amplitude,
                     parameters});
    }
    text += fmt::format(
        "</table><p>* in the 90 % set. An effect is named from {:.3f} on (fixed by simulated cases before the data were looked at, temperature {:.2f}). "
        "Adequacy: parameters only p = {:.3f}, best explanation "
        "«{}» p = {:.3f} (weakest in «{}»), refused below {:.3f}.</p><p>Library signatures closest to the baseline's residual: ",
        d.claim_threshold, d.temperature, d.baseline_p, escaped(d.best_name), d.best_p, escaped(d.misfit_family), d.adequacy_threshold);
    for (std::size_t i = 0; i < d.nearest.size(); ++i) text += (i == 0 ? "" : ", ") + escaped(d.nearest[i]);
    return text + ".</p>";
}

std::string how_far_section(const Diagnosis& d) {
    std::string text = "<h2>How far</h2><div class=row>" + detail::budget_bars(d) + "</div><table>" +
                       row({"data", "before", "after", "placebo", "noise", "shrink", "90 % interval"}, "th");
    for (const DiagnosisShrink& s : d.how_far)
        text += row({escaped(s.data), number(s.before), number(s.after), number(s.placebo), number(s.floor), number(100 * s.shrink, "{:.0f} %"),
                     number(100 * s.lower, "{:.0f}") + " to " + number(100 * s.upper, "{:.0f} %")});
    text +=
        "</table><p class=soft>Root mean square miss in tolerances, measurement noise taken out; both fitted to the same data; the placebo is the most "
        "probable other effect. Predicted by the emulator.</p><p>Confirmation " +
        escaped(d.confirmation) + "</p>";
    if (!std::isnan(d.transfer_p)) text += fmt::format("<p>Calibrated on one part of the data, the miss of the rest has p = {:.4f}.</p>", d.transfer_p);
    return text;
}

std::string plan_section(const Diagnosis& d) {
    std::string text =
        "<h2>What these data can see</h2><p class=soft>Computed before the data were judged. λ is the squared distance, in standard deviations, between a "
        "reality with the effect at the end of its range and the best that the "
        "other explanation can do: below 9 it cannot be seen, below 16 it can be mistaken.</p><table>" +
        row({"effect", "λ against calibration", "worst place", "absorbed", "seen from", "wrong-name bound"}, "th");
    for (const auto& e : d.plan.effects)
        text += row({escaped(e.name), number(e.detectability), number(e.smallest_detectability), number(100 * e.absorbed_share, "{:.0f} %"),
                     escaped(e.amplitude_text), number(100 * e.expected_error, "{:.1f} %")});
    text += "</table><table>";
    std::vector<std::string> head{"λ: truth ↓ mistaken for →"};
    for (const auto& e : d.plan.effects) head.push_back(escaped(e.name));
    text += row(head, "th");
    for (std::size_t k = 0; k < d.plan.separability.size(); ++k) {
        std::vector<std::string> cells{escaped(d.plan.effects[k].name)};
        for (std::size_t l = 0; l < d.plan.separability.size(); ++l) cells.push_back(k == l ? "" : number(d.plan.separability[k][l]));
        text += row(cells);
    }
    text += "</table><table>" + row({"group", "leverage"}, "th");
    for (const auto& l : d.plan.leverages)
        text += row({escaped(l.group), number(l.largest, "{:.2f}") + (l.largest > 0.8 ? " <span class=gap>blind spot</span>" : "")});
    text += "</table><table>" + row({"direction of the parameters", "share of its range left open"}, "th");
    for (const auto& one : d.plan.directions) text += row({escaped(one.text), number(100 * one.deviation, "{:.0f} %")});
    text += "</table><ul>";
    for (const std::string& line : d.emulator) text += "<li>" + escaped(line) + "</li>";
    return text + "</ul>";
}

}  // namespace

std::string diagnosis_html(const Diagnosis& d) {
    std::string text =
        fmt::format("<!doctype html><html lang=en><meta charset=utf-8><title>{}: {}</title><style>{}</style><h1>{}</h1><p class=soft>against {} ({})</p>",
                    escaped(d.name), verdict_code(d.verdict), style, escaped(d.name), escaped(d.campaign), escaped(d.campaign_source));
    text += fmt::format("<div class=verdict><b>{}</b><br>{}</div>", verdict_code(d.verdict), escaped(d.statement));
    text += where_section(d) + which_section(d) + how_far_section(d);
    text += "<h2>What next</h2>";
    if (d.next.empty()) {
        text += "<p>The experiment names no candidates: add [[candidate]] tables with costs.</p>";
    } else {
        text += "<table>" + row({"measurement", "cost", "information [nats]", "per cost"}, "th");
        for (const auto& n : d.next) text += row({escaped(n.name), number(n.cost), number(n.information), number(n.per_cost)});
        text += "</table>";
    }
    text += plan_section(d) + "<h2>Audit and notes</h2><ul>";
    for (const AuditItem& item : d.audit) text += fmt::format("<li{}>{}</li>", item.is_warning ? " class=gap" : "", escaped(item.text));
    for (const std::string& note : d.notes) text += "<li>" + escaped(note) + "</li>";
    text += fmt::format("</ul><p class=soft>pelletlab {} ({}), seed {}", escaped(d.provenance.version), escaped(d.provenance.git_hash), d.provenance.seed);
    for (const auto& [name, hash] : d.provenance.input_hashes) text += fmt::format(", {} {}", escaped(name), hash.substr(0, 12));
    return text + "</p></html>\n";
}

}  // namespace pelletlab::report
