// The store of a campaign as a table: campaign.toml and runs.csv.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/campaign_stage.hpp"
#include "apps/terminal.hpp"
#include "campaign/design.hpp"
#include "core/error.hpp"
#include "core/provenance.hpp"
#include "experiments/effects/effects.hpp"
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

/// A profile at x. Bins of a run may lie elsewhere than those of the column (they go with the size of its pellets): linear between them, the end bin's own
/// value up to its edge, NaN beyond.
double value_at(const Profile& p, double x) {
    for (std::size_t i = 0; i < p.axis.size(); ++i)
        if (std::abs(p.axis[i] - x) < 1e-9 * std::max(1.0, std::abs(x))) return p.value[i];
    if (p.axis.size() < 2) return not_known;
    const double half = 0.5 * (p.axis[1] - p.axis[0]);
    if (x < p.axis.front() - half || x > p.axis.back() + half) return not_known;
    if (x < p.axis.front()) return p.value.front();
    if (x > p.axis.back()) return p.value.back();
    const auto above = static_cast<std::size_t>(std::upper_bound(p.axis.begin(), p.axis.end(), x) - p.axis.begin());
    const double t = (x - p.axis[above - 1]) / (p.axis[above] - p.axis[above - 1]);
    return (1.0 - t) * p.value[above - 1] + t * p.value[above];
}

/// Value of one column in a run; NaN when the run does not have it.
double value_in(const Observables& run, const Column& column, double axis) {
    if (!column.is_profile) {
        for (const Observable& o : run.values)
            if (o.name == column.observable) return o.value;
        return not_known;
    }
    for (const Profile& p : run.profiles)
        if (p.name == column.observable) return value_at(p, axis);
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

/// A row of the table: a run, or a run as an instrument with an effect would have read it.
struct TableRow {
    std::string rig, status;
    std::uint64_t seed = 0;
    std::vector<double> parameters, effects, values;
};

TableRow row_of(const io::StoredRun& run, const std::vector<double>& effects, const std::vector<Column>& columns, const Observables& measured) {
    TableRow row{run.rig, run.state == io::RunState::failed ? "failed" : measured.status, run.seed, run.parameters, effects, {}};
    std::replace(row.status.begin(), row.status.end(), ',', ';');
    for (const Column& c : columns) {
        if (!c.is_profile) row.values.push_back(value_in(measured, c, 0.0));
        for (const double x : c.axis) row.values.push_back(value_in(measured, c, x));
    }
    return row;
}

/// Effects of the measurement: the base points' own values, as such an instrument would have given them. A base point that failed has no reading.
std::vector<TableRow> readings_in(const CampaignPlan& plan, const std::vector<Column>& columns, const std::vector<io::StoredRun>& rows,
                                  const std::vector<Observables>& measured) {
    std::vector<TableRow> readings;
    for (const PlannedReading& reading : campaign::readings_of(plan))
        for (std::size_t rig = 0; rig < plan.rigs.size(); ++rig) {
            const std::size_t i = static_cast<std::size_t>(reading.point) * plan.rigs.size() + rig;  // the design begins with the base points
            if (rows[i].state != io::RunState::finished) continue;
            Observables seen = measured[i];
            for (std::size_t k = 0; k < plan.effects.size(); ++k)
                if (reading.effects[k] != plan.effects[k].baseline)
                    seen = experiments::with_effect(experiments::effect_named(plan.effects[k].name), std::move(seen), reading.effects[k]);
            readings.push_back(row_of(rows[i], reading.effects, columns, seen));
        }
    return readings;
}

std::string csv_of(const CampaignPlan& plan, const std::vector<Column>& columns, const std::vector<TableRow>& rows) {
    std::string text = "regime,status,seed";
    for (const auto& p : plan.parameters) text += "," + p.name;
    for (const auto& e : plan.effects) text += "," + e.name;
    for (const Column& c : columns) {
        if (!c.is_profile) text += "," + c.observable;
        for (const double x : c.axis) text += fmt::format(",{}({:.9g})", c.observable, x);
    }
    text += "\n";
    for (const TableRow& row : rows) {
        text += fmt::format("{},{},{}", row.rig, row.status, row.seed);
        for (const auto* numbers : {&row.parameters, &row.effects, &row.values})
            for (const double v : *numbers) text += "," + field(v);
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
    std::vector<TableRow> table;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (has_ended(rows[i])) table.push_back(row_of(rows[i], rows[i].effects, columns, measured[i]));
    const auto readings = readings_in(campaign.plan, columns, rows, measured);
    table.insert(table.end(), readings.begin(), readings.end());
    io::write_text(campaign.folder / "runs.csv", csv_of(campaign.plan, columns, table));
    io::write_text(campaign.folder / "campaign.toml", description_of(campaign.plan, columns));
    const auto open = std::count_if(rows.begin(), rows.end(), [](const io::StoredRun& run) { return !has_ended(run); });
    const auto failed = std::count_if(rows.begin(), rows.end(), [](const io::StoredRun& run) { return run.state == io::RunState::failed; });
    print_written(campaign.folder / "runs.csv",
                  fmt::format("{} runs{}{}{}", static_cast<std::ptrdiff_t>(rows.size()) - open, failed > 0 ? fmt::format(", {} of them failed", failed) : "",
                              readings.empty() ? "" : fmt::format("; {} readings of them by instruments with an effect", readings.size()),
                              open > 0 ? fmt::format("; {} are still to be run", open) : ""));
    print_written(campaign.folder / "campaign.toml", "what diagnose and calibrate read");
}

}  // namespace pelletlab::apps
