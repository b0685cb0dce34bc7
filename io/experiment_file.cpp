#include <algorithm>
#include <cmath>
#include <tuple>

#include "io/campaign_file.hpp"
#include "io/csv_table.hpp"
#include "io/detail/toml_table.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using detail::TomlTable;

double positive(TomlTable& t, const std::string& key) {
    const double value = t.number(key);
    if (!(value > 0.0)) throw t.problem(key, "must be positive", "write a number > 0");
    return value;
}

MeasurementRole read_role(TomlTable& t) {
    const std::string role = t.choice("role", "fit", {"fit", "calibration", "held_out"});
    return role == "fit" ? MeasurementRole::fit : role == "calibration" ? MeasurementRole::calibration : MeasurementRole::held_out;
}

Error no_uncertainty(const TomlTable& t, const std::string& name) {
    return bad_input(
        "the measurement '" + name + "' has no uncertainty",
        "give uncertainty = …, the standard error of the mean (spread of the repeats / √repeats), or an uncertainty_column; without it nothing can be said",
        t.place());
}

void read_profile(TomlTable& t, Measurement& m, const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / t.text("data");
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) throw t.problem("data", "names a file that does not exist: " + file.string(), "correct the path");
    const CsvTable csv = read_csv(file);
    const std::size_t axis = csv.column(t.text("axis_column")), value = csv.column(t.text("value_column"));
    m.axis_unit = t.unit("axis_unit", "1");
    const bool has_column = t.has("uncertainty_column");
    const std::size_t spread = has_column ? csv.column(t.text("uncertainty_column")) : 0;
    const double common = has_column ? 0.0 : t.has("uncertainty") ? positive(t, "uncertainty") : throw no_uncertainty(t, m.name);
    const auto range = t.range_if_any("axis_range", "write axis_range = [-0.6, 0.6]");
    std::string content;
    for (std::size_t r = 0; r < csv.fields.size(); ++r) {
        const double x = csv.number(r, axis), y = csv.number(r, value);
        if (std::isnan(x)) throw bad_input("the axis value is missing", "every point needs one", csv.place(r, axis));
        if (std::isnan(y) || (range && (x < range->first - 1e-9 || x > range->second + 1e-9))) continue;
        const double u = has_column ? csv.number(r, spread) : common;
        if (!(u > 0.0)) throw bad_input("the uncertainty is missing or not positive", "every point needs one", csv.place(r, spread));
        if (!m.axis.empty() && x <= m.axis.back()) throw bad_input("the axis does not ascend", "sort the rows by the axis", csv.place(r, axis));
        m.axis.push_back(x);
        m.value.push_back(y);
        m.uncertainty.push_back(u);
        content += csv.fields[r][value] + "\n";
    }
    if (m.axis.size() < 2) throw t.problem("data", "holds fewer than two usable points", "check columns and axis_range");
    m.data_sha256 = sha256_of_text(content);
}

Measurement read_measurement(TomlTable& t, const std::filesystem::path& folder) {
    Measurement m;
    m.place = t.place();
    m.observable = t.text("observable");
    m.regime = t.text("regime", "");
    m.name = t.text("name", m.observable + (m.regime.empty() ? "" : " " + m.regime));
    m.unit = t.unit("unit", "1");
    m.instrument = t.text("instrument", "");
    m.repeats = t.whole("repeats", 1, 1, 1000000);
    m.offset_uncertainty = t.number("offset_uncertainty", 0.0);
    if (m.offset_uncertainty < 0.0) throw t.problem("offset_uncertainty", "is negative", "write a number >= 0");
    if (t.has("tolerance")) m.tolerance = positive(t, "tolerance");
    m.role = read_role(t);
    if (t.has("picture")) {
        const std::filesystem::path picture = folder / t.text("picture");
        m.picture = sha256_of_file(picture);
    }
    if (t.has("data")) {
        read_profile(t, m, folder);
    } else {
        m.value = {t.number("value")};
        if (!t.has("uncertainty")) throw no_uncertainty(t, m.name);
        m.uncertainty = {positive(t, "uncertainty")};
        m.data_sha256 = "";
    }
    return m;
}

CalibrationParameter read_parameter(TomlTable& t) {
    CalibrationParameter p;
    p.place = t.place();
    p.name = t.text("name");
    if (t.has("value")) {
        p.lower = p.upper = t.number("value");
        p.fixed = true;
        return p;
    }
    std::tie(p.lower, p.upper) = t.range("range", "write range = [0.1, 1.0], or value = 0.5 for a known parameter");
    return p;
}

Candidate read_candidate(TomlTable& t) {
    Candidate c;
    c.place = t.place();
    c.name = t.text("name");
    c.cost = positive(t, "cost");
    c.uncertainty = positive(t, "uncertainty");
    c.direct = t.text("measures", "");
    c.observable = t.text("observable", "");
    c.regime = t.text("regime", "");
    if (c.direct.empty() == c.observable.empty())
        throw t.problem("name", "is neither a direct measurement nor a new observation",
                        "give either measures = \"effect or parameter\" or observable and regime");
    return c;
}

DiagnosisSettings read_settings(TomlTable& t) {
    DiagnosisSettings s;
    s.seed = static_cast<std::uint64_t>(t.whole("seed", 1, 0, 2147483647));
    s.bootstrap = t.whole("bootstrap", s.bootstrap, 100, 100000);
    s.recalibration_cases = t.whole("recalibration_cases", s.recalibration_cases, 0, 100000);
    s.scatter_of_one_run = t.choice("scatter", "as stated", {"as stated", "one run"}) == "one run";
    s.tolerance_correlation = t.number("tolerance_correlation", s.tolerance_correlation);
    if (!(s.tolerance_correlation >= 0.0 && s.tolerance_correlation < 1.0)) throw t.problem("tolerance_correlation", "must lie in [0, 1)", "0.5 is usual");
    s.false_discovery_rate = t.number("false_discovery_rate", s.false_discovery_rate);
    if (!(s.false_discovery_rate > 0.0 && s.false_discovery_rate < 0.5)) throw t.problem("false_discovery_rate", "must lie in (0, 0.5)", "0.05 is usual");
    t.finish();
    return s;
}

}  // namespace

Experiment read_experiment(const std::filesystem::path& file) {
    const std::string text = read_text(file);
    const toml::table toml = detail::parse_toml(text, file.string());
    TomlTable t(toml, file.string(), "");
    Experiment e;
    e.file = file.string();
    e.text_sha256 = sha256_of_text(text);
    e.name = t.text("name", file.stem().string());
    e.campaign_file = (file.parent_path() / t.text("campaign")).string();
    e.library = t.texts("library");
    e.suspects = t.texts("suspects");
    t.each("exclude", [&](TomlTable& one) { e.exclude.push_back(one.all_numbers()); });
    t.each("parameter", [&](TomlTable& one) { e.parameters.push_back(read_parameter(one)); });
    t.each("measurement", [&](TomlTable& one) { e.measurements.push_back(read_measurement(one, file.parent_path())); });
    t.each("region", [&](TomlTable& one) {
        Region r;
        r.observable = one.text("observable");
        r.name = one.text("name");
        std::tie(r.lower, r.upper) = one.range("range", "write range = [-0.6, -0.3]");
        e.regions.push_back(r);
    });
    t.each("candidate", [&](TomlTable& one) { e.candidates.push_back(read_candidate(one)); });
    if (auto settings = t.table("settings")) e.settings = read_settings(*settings);
    t.finish();
    if (e.measurements.empty()) throw bad_input("the experiment has no [[measurement]]", "add what was measured", {file.string()});
    return e;
}

}  // namespace pelletlab::io
