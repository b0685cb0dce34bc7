// pelletlab calibrate: what the measurements say about the parameters, and what they leave open.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/terminal.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "core/provenance.hpp"
#include "diagnosis/calibrate.hpp"
#include "io/campaign_file.hpp"
#include "io/files.hpp"
#include "report/chart.hpp"
#include "report/render.hpp"

namespace pelletlab::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct CalibrateOptions {
    std::string experiment, output;
    bool no_picture = false;
};

std::string with_unit(double value, const std::string& unit) {
    return unit == "1" ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

Json json_of(const diagnosis::Calibration& c, const Experiment& experiment) {
    Json j;
    j["format"] = "pelletlab-calibration";
    j["format_version"] = 1;
    j["experiment"] = experiment.name;
    j["chi2"] = c.chi2;
    j["data"] = c.data;
    j["adequacy_p"] = c.adequacy_p;
    j["effective_samples"] = c.effective_samples;
    for (const auto& p : c.parameters)
        j["parameters"].push_back({{"name", p.name},
                                   {"unit", p.unit},
                                   {"range", {p.prior_lower, p.prior_upper}},
                                   {"best", p.best},
                                   {"mean", p.mean},
                                   {"interval_90", {p.lower, p.upper}},
                                   {"narrowed_to", p.narrowed},
                                   {"profile", {{"value", p.profile_value}, {"chi2", p.profile_chi2}}}});
    for (Eigen::Index i = 0; i < c.correlation.rows(); ++i) {
        std::vector<double> row(static_cast<std::size_t>(c.correlation.cols()));
        for (Eigen::Index k = 0; k < c.correlation.cols(); ++k) row[static_cast<std::size_t>(k)] = c.correlation(i, k);
        j["correlation"].push_back(row);
    }
    j["left_open"] = Json::array();
    for (const auto& d : c.open) j["left_open"].push_back({{"direction", d.text}, {"posterior_over_prior", d.deviation}});
    for (const auto& n : c.next) j["next"].push_back({{"observable", n.observable}, {"regime", n.regime}, {"information_nats", n.information}});
    for (const auto& d : c.draws) j["draws"].push_back(std::vector<double>(d.data(), d.data() + d.size()));
    j["provenance"] = {
        {"version", build_version()}, {"git_hash", build_git_hash()}, {"seed", experiment.settings.seed}, {"experiment_sha256", experiment.text_sha256}};
    return j;
}

/// The two parameters that the data bind together most: the valley.
report::Image valley_of(const diagnosis::Calibration& c) {
    Eigen::Index a = 0, b = c.correlation.rows() > 1 ? 1 : 0;
    for (Eigen::Index i = 0; i < c.correlation.rows(); ++i)
        for (Eigen::Index j = 0; j < i; ++j)
            if (std::abs(c.correlation(i, j)) > std::abs(c.correlation(a, b)) || a == b) a = j, b = i;
    const auto name = [&](Eigen::Index i) {
        const auto& p = c.parameters[static_cast<std::size_t>(i)];
        return p.unit == "1" ? p.name : p.name + " (" + p.unit + ")";
    };
    report::Chart chart;
    chart.title = fmt::format("Sets of parameters that describe the data equally well (correlation {:.2f})", c.correlation(a, b));
    chart.horizontal = {name(a), false};
    chart.vertical = {name(b), false};
    report::ChartSeries range, cloud, best;
    const auto &pa = c.parameters[static_cast<std::size_t>(a)], &pb = c.parameters[static_cast<std::size_t>(b)];
    range.name = "range before the measurements";
    range.points = {{pa.prior_lower, pb.prior_lower},
                    {pa.prior_upper, pb.prior_lower},
                    {pa.prior_upper, pb.prior_upper},
                    {pa.prior_lower, pb.prior_upper},
                    {pa.prior_lower, pb.prior_lower}};
    range.line = range.dashed = true;
    range.colour = {150, 150, 150};
    range.marker = report::Marker::cross;
    cloud.name = fmt::format("{} sets drawn from the posterior", c.draws.size());
    for (const auto& d : c.draws) cloud.points.push_back({d[a], d[b]});
    cloud.marker = report::Marker::ring;
    best.name = "best set";
    best.points = {{pa.best, pb.best}};
    best.colour = {178, 24, 43};
    best.marker = report::Marker::diamond;
    chart.series = {range, cloud, best};
    return picture_of_chart(chart, {});
}

void print_calibration(const diagnosis::Calibration& c) {
    std::vector<std::vector<std::string>> rows{{"parameter", "range", "best", "90 % interval", "narrowed to"}};
    for (const auto& p : c.parameters)
        rows.push_back({p.name, with_unit(p.prior_lower, p.unit) + " to " + with_unit(p.prior_upper, p.unit), with_unit(p.best, p.unit),
                        with_unit(p.lower, p.unit) + " to " + with_unit(p.upper, p.unit), fmt::format("{:.0f} %", 100.0 * p.narrowed)});
    print_table(rows);
    print_line(fmt::format("  misfit: chi-square {:.1f} for {} data; adequate with p = {:.3f}{}", c.chi2, c.data, c.adequacy_p,
                           c.adequacy_p < 0.05 ? ": no set of parameters in the range describes the data (" + c.misfit + "); ask pelletlab diagnose" : ""));
    if (c.open.empty()) print_line("  every direction is determined: the posterior is less than half as wide as the range in all of them");
    for (const auto& d : c.open) print_line(fmt::format("  NOT determined by these data: {} ({:.0f} % of what the range allows)", d.text, 100.0 * d.deviation));
    if (!c.open.empty())
        for (std::size_t i = 0; i < std::min<std::size_t>(3, c.next.size()); ++i)
            print_line(fmt::format("  a measurement of {} ({}) would add {:.1f} nats", c.next[i].observable, c.next[i].regime, c.next[i].information));
}

void run_calibrate(const CalibrateOptions& options) {
    const Stopwatch stopwatch;
    const Experiment experiment = io::read_experiment(options.experiment);
    const Campaign campaign = campaign::assemble(io::read_campaign(experiment.campaign_file));
    const diagnosis::Problem problem = diagnosis::make_problem(diagnosis::make_model(campaign, experiment.library, experiment.exclude, experiment.file),
                                                               experiment, diagnosis::FewData::allow);
    const fs::path folder = options.output.empty() ? fs::path("out") / ("calibration-" + experiment.name) : fs::path(options.output);
    io::prepare_output_folder(folder);
    const diagnosis::Attributor attributor(problem);
    const diagnosis::Calibration c = diagnosis::calibrate(attributor);
    print_calibration(c);
    io::write_text(folder / "calibration.json", json_of(c, experiment).dump(1) + "\n");
    print_written(folder / "calibration.json", "posterior: intervals, correlations, profiles, draws");
    if (!options.no_picture && c.parameters.size() > 1) {
        report::write_png(valley_of(c), folder / "valley.png");
        print_written(folder / "valley.png", "the two parameters that the data bind together most");
    }
    print_line(fmt::format("  took {}", duration_text(stopwatch.seconds())));
}

}  // namespace

void add_calibrate_verb(CLI::App& app) {
    auto options = std::make_shared<CalibrateOptions>();
    CLI::App* verb = app.add_subcommand("calibrate",
                                        "Calibrate a campaign's parameters on measurements: intervals, correlations, and what stays undetermined\n"
                                        "  example: pelletlab calibrate examples/diagnosis/experiment.toml -o out/calibration");
    verb->add_option("experiment", options->experiment, "experiment.toml: what was measured, and the campaign of runs (docs/diagnosis.md)")->required();
    verb->add_option("-o,--output", options->output, "Folder of the results; out/calibration-<name> when not given");
    verb->add_flag("--no-picture", options->no_picture, "Write no picture");
    verb->callback([options] { run_calibrate(*options); });
}

}  // namespace pelletlab::apps
