// The store of a campaign as a table: campaign.toml and runs.csv.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/campaign_stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/provenance.hpp"
#include "io/files.hpp"
#include "io/observables_file.hpp"

namespace pelletlab::apps {

namespace {

/// An observable of the plan as the runs have it: one column, or one for each bin of a profile.
struct Column {
    std::string observable, unit, axis_name, axis_unit;
    double tolerance = 0.0;
    bool is_profile = false;
    std::vector<double> axis;
};

/// Value of one column in a run; NaN when the run does not have it.
double value_in(const Observables& run, const Column& column, double axis) {
    if (!column.is_profile) {
        for (const Observable& o : run.values)
            if (o.name == column.observable) return o.value;
        return not_known;
    }
    for (const Profile& p : run.profiles) {
        if (p.name != column.observable) continue;
        for (std::size_t i = 0; i < p.axis.size(); ++i)
            if (std::abs(p.axis[i] - axis) < 1e-9 * std::max(1.0, std::abs(axis))) return p.value[i];
    }
    return not_known;
}

Column column_of(const PlannedObservable& wanted, const std::vector<Observables>& runs, const std::string& file) {
    Column column;
    column.observable = wanted.name;
    column.tolerance = wanted.tolerance;
    for (const Observables& run : runs) {
        for (const Observable& o : run.values)
            if (o.name == wanted.name) {
                column.unit = o.unit;
                return column;
            }
        for (const Profile& p : run.profiles) {
            if (p.name != wanted.name) continue;
            column.is_profile = true;
            column.unit = p.unit;
            column.axis_name = p.axis_name;
            column.axis_unit = p.axis_unit;
            for (const double x : p.axis)
                if (wanted.axis_lower == wanted.axis_upper || (x >= wanted.axis_lower && x <= wanted.axis_upper)) column.axis.push_back(x);
            return column;
        }
    }
    std::string known;
    for (std::size_t i = 0; known.empty() && i < runs.size(); ++i)
        for (const Observable& o : runs[i].values) known += (known.empty() ? "" : ", ") + o.name;
    throw bad_input("no finished run measures '" + wanted.name + "'", known.empty() ? "run the campaign first" : "the first run has: " + known, {file});
}

std::string field(double value) {
    return std::isfinite(value) ? fmt::format("{:.17g}", value) : std::string();
}

/// A text between quotes: what JSON writes is a text of TOML too.
std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump();
}

bool has_ended(const io::StoredRun& run) {
    return run.state == io::RunState::finished || run.state == io::RunState::failed;
}

std::string csv_of(const CampaignPlan& plan, const std::vector<Column>& columns, const std::vector<io::StoredRun>& rows,
                   const std::vector<Observables>& measured) {
    std::string text = "regime,status,seed";
    for (const auto& p : plan.parameters) text += "," + p.name;
    for (const auto& e : plan.effects) text += "," + e.name;
    for (const Column& c : columns) {
        if (!c.is_profile) text += "," + c.observable;
        for (const double x : c.axis) text += fmt::format(",{}({:.9g})", c.observable, x);
    }
    text += "\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!has_ended(rows[i])) continue;
        std::string status = rows[i].state == io::RunState::failed ? "failed" : measured[i].status;
        std::replace(status.begin(), status.end(), ',', ';');
        text += fmt::format("{},{},{}", rows[i].rig, status, rows[i].seed);
        for (const double v : rows[i].parameters) text += "," + field(v);
        for (const double v : rows[i].effects) text += "," + field(v);
        for (const Column& c : columns) {
            if (!c.is_profile) text += "," + field(value_in(measured[i], c, 0.0));
            for (const double x : c.axis) text += "," + field(value_in(measured[i], c, x));
        }
        text += "\n";
    }
    return text;
}

std::string description_of(const CampaignPlan& plan, const std::vector<Column>& columns) {
    std::string text = fmt::format("# Made by pelletlab campaign from {}\nname = {}\nsource = {}\ntable = \"runs.csv\"\nlargest_failed_share = {}\n", plan.file,
                                   quoted(plan.name), quoted("pelletlab " + build_version()), plan.largest_failed_share);
    text += "\n[status]\ncolumn = \"status\"\ngood = " + nlohmann::json(plan.good).dump() + "\n\n[regime]\ncolumn = \"regime\"\nname = \"rig\"\n";
    for (const auto& p : plan.parameters)
        text += fmt::format("\n[[parameter]]\nname = {}\nunit = {}\nrange = [{:.17g}, {:.17g}]\nscale = {}\n", quoted(p.name), quoted(p.unit), p.lower, p.upper,
                            quoted(p.logarithmic ? "log" : "linear"));
    for (const auto& e : plan.effects)
        text += fmt::format("\n[[effect]]\nname = {}\ntitle = {}\nunit = {}\nbaseline = {:.17g}\nfull = {:.17g}\nscale = {}\ntwo_sided = {}\nclass = {}\n",
                            quoted(e.name), quoted(e.title), quoted(e.unit), e.baseline, e.full, quoted(e.square_root ? "sqrt" : "linear"), e.two_sided,
                            quoted(e.effect_class));
    for (const Column& c : columns) {
        text += fmt::format("\n[[observable]]\nname = {}\nunit = {}\ntolerance = {:.17g}\n", quoted(c.observable), quoted(c.unit), c.tolerance);
        if (c.is_profile)
            text += fmt::format("columns = {}\naxis = {}\naxis_unit = {}\n", quoted(c.observable + "(*)"), quoted(c.axis_name), quoted(c.axis_unit));
    }
    return text;
}

}  // namespace

void export_campaign(const OpenedCampaign& campaign) {
    const io::CampaignStore store(store_file(campaign.folder));
    const auto rows = store.runs();
    std::vector<Observables> measured(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].state == io::RunState::finished) measured[i] = io::parse_observables(rows[i].observables, fmt::format("run {}", rows[i].number));
    std::vector<Column> columns;
    for (const PlannedObservable& o : campaign.plan.observables) columns.push_back(column_of(o, measured, campaign.plan.file));
    io::write_text(campaign.folder / "runs.csv", csv_of(campaign.plan, columns, rows, measured));
    io::write_text(campaign.folder / "campaign.toml", description_of(campaign.plan, columns));
    const auto open = std::count_if(rows.begin(), rows.end(), [](const io::StoredRun& run) { return !has_ended(run); });
    const auto failed = std::count_if(rows.begin(), rows.end(), [](const io::StoredRun& run) { return run.state == io::RunState::failed; });
    print_written(campaign.folder / "runs.csv",
                  fmt::format("{} runs{}{}", static_cast<std::ptrdiff_t>(rows.size()) - open, failed > 0 ? fmt::format(", {} of them failed", failed) : "",
                              open > 0 ? fmt::format("; {} are still to be run", open) : ""));
    print_written(campaign.folder / "campaign.toml", "what diagnose and calibrate read");
}

}  // namespace pelletlab::apps
