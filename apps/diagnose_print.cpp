#include "apps/diagnose_print.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/terminal.hpp"

namespace pelletlab::apps {

namespace {

std::string number(double value, const char* format = "{:.3g}") {
    return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

}  // namespace

void print_plan(const Diagnosis& d) {
    print_line("\n== What these data can see (before they are judged)");
    std::vector<std::vector<std::string>> rows{{"effect", "lambda", "worst", "absorbed by calibration", "seen from", "wrong-name bound"}};
    for (const auto& e : d.plan.effects)
        rows.push_back({e.name, number(e.detectability), number(e.smallest_detectability), fmt::format("{:.0f} %", 100 * e.absorbed_share), e.amplitude_text,
                        fmt::format("{:.1f} %", 100 * e.expected_error)});
    print_table(rows);
    for (std::size_t k = 0; k < d.plan.separability.size(); ++k)
        for (std::size_t l = 0; l < d.plan.separability.size(); ++l)
            if (k != l && d.plan.separability[k][l] < 16.0)
                print_line(
                    fmt::format("  {} can be mistaken for {}: lambda {:.1f} < 16", d.plan.effects[k].name, d.plan.effects[l].name, d.plan.separability[k][l]));
    for (const auto& l : d.plan.leverages)
        if (l.largest > 0.8) print_line(fmt::format("  blind spot: {} (leverage {:.2f}): calibration would hide a gap there", l.group, l.largest));
    for (const auto& direction : d.plan.directions)
        if (direction.deviation > 0.5) print_line(fmt::format("  not determined: {} keeps {:.0f} % of its range", direction.text, 100 * direction.deviation));
    for (const std::string& line : d.emulator) print_line("  emulator: " + line);
}

void print_answers(const Diagnosis& d) {
    print_line(fmt::format("\n== {}\n  {}", verdict_code(d.verdict), d.statement));
    print_line("\n== Where");
    std::vector<std::vector<std::string>> where{{"group", "gap", "90 % interval", "p", "", "explained", "90 % interval", "", "left out: z"}};
    for (const auto& w : d.where)
        where.push_back({w.group, number(w.gap), number(w.lower) + " to " + number(w.upper), number(w.p, "{:.4f}"), w.discovery ? "GAP" : "",
                         number(w.explained), number(w.explained_lower) + " to " + number(w.explained_upper), w.explained_discovery ? "GAP" : "",
                         number(w.left_out_z, "{:.1f}")});
    print_table(where);
    print_line("  first GAP: by the group's own data; second: by the explanation, for which all data speak, and only as right as that");
    print_line("\n== Which");
    std::vector<std::vector<std::string>> which{{"explanation", "probability", "chi2", "amplitude (90 %)"}};
    for (const auto& h : d.hypotheses) {
        std::string amplitude;
        for (const auto& a : h.amplitudes) amplitude += (amplitude.empty() ? "" : "; ") + a.effect + " " + a.text;
        if (h.probability > 0.002) which.push_back({h.name + (h.in_set ? " *" : ""), number(h.probability, "{:.3f}"), number(h.chi2), amplitude});
    }
    print_table(which);
    print_line(fmt::format("  * in the 90 % set; claim from {:.3f}; adequacy of the best: p = {:.3f} (refused below {:.3f}); parameters only: p = {:.3f}",
                           d.claim_threshold, d.best_p, d.adequacy_threshold, d.baseline_p));
    if (!std::isnan(d.transfer_p)) print_line(fmt::format("  calibrated on one part, the miss of the rest: p = {:.4f}", d.transfer_p));
    print_line("\n== How far (root mean square miss in tolerances)");
    std::vector<std::vector<std::string>> far{{"data", "before", "after", "placebo", "noise", "shrink", "90 % interval"}};
    for (const auto& s : d.how_far)
        far.push_back({s.data, number(s.before), number(s.after), number(s.placebo), number(s.floor), fmt::format("{:.0f} %", 100 * s.shrink),
                       fmt::format("{:.0f} to {:.0f} %", 100 * s.lower, 100 * s.upper)});
    print_table(far);
    print_line("  confirmation " + d.confirmation);
    if (!d.next.empty()) {
        print_line("\n== What next (information about the explanation per cost)");
        std::vector<std::vector<std::string>> next{{"measurement", "cost", "nats", "nats/cost"}};
        for (const auto& n : d.next) next.push_back({n.name, number(n.cost), number(n.information), number(n.per_cost)});
        print_table(next);
    }
    for (const std::string& note : d.notes) print_line("  note: " + note);
}

}  // namespace pelletlab::apps
