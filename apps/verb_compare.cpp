// pelletlab compare tube: filled tubes against measured heights, shape against shape, and both against published correlations.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "apps/shape_stage.hpp"
#include "apps/terminal.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "io/case_file.hpp"
#include "io/files.hpp"
#include "io/measured_fills.hpp"
#include "io/observables_file.hpp"
#include "io/trajectory_file.hpp"
#include "packing/compare_beds.hpp"
#include "packing/voidage_correlations.hpp"
#include "report/chart.hpp"
#include "report/pictures.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

struct CompareOptions {
    std::string measured, unit, definition = "bed_height_h95", folder = "compared";
    std::vector<std::string> runs;
    double margin_percent = 2.0;
    bool no_picture = false;
};

struct Run {
    packing::SimulatedBed bed;
    std::string conditions;  ///< the case without what repeats may differ in
};

/// The resolved case without its name and seed.
std::string conditions_of(const std::string& resolved) {
    std::istringstream lines(resolved);
    std::string text, line;
    while (std::getline(lines, line))
        if (line.rfind("seed =", 0) != 0 && line.rfind("name =", 0) != 0) text += line + "\n";
    return text;
}

Run read_run(const fs::path& folder, const std::string& definition) {
    const fs::path file = folder / "observables.json";
    if (!fs::exists(file)) throw bad_input("'" + folder.string() + "' holds no finished run", "name the result folders of pelletlab fill", {folder.string()});
    const Observables observables = io::read_observables(file);
    const auto trajectory = io::open_trajectory(folder / "run.h5");
    const TrajectoryHeader& head = trajectory->header();
    const Case c = io::parse_case(head.resolved_case, (folder / "run.h5").string());
    if (c.rig != Rig::tube)
        throw bad_input("'" + folder.string() + "' is a run of the rig '" + rig_name(c.rig) + "'", "name runs of pelletlab fill", {folder.string()});
    Run run;
    packing::SimulatedBed& bed = run.bed;
    bed.folder = folder.string();
    bed.shape = stem_of(c.pellet.clump_file).filename().string();
    bed.spheres = static_cast<double>(head.shapes.at(0).rigid.spheres.size());
    bed.pellets = static_cast<double>(head.shape_of_body.size());
    bed.pellet_mass = head.shapes[0].rigid.mass_properties.mass;
    bed.pellet_volume = head.shapes[0].rigid.mass_properties.volume;
    bed.tube_diameter = c.tube.diameter;
    bed.seed = c.seed;
    bed.at_rest = observables.status != "not at rest";
    if (bed.at_rest && observables.status != "complete") print_line(folder.string() + ": " + observables.status);
    bool found = false;
    std::string names;
    for (const Observable& o : observables.values) {
        if (o.unit == "mm") names += (names.empty() ? "" : ", ") + o.name;
        if (o.name != definition) continue;
        if (o.unit != "mm") throw bad_input("'" + definition + "' is not a height", "one of: " + names, {file.string()});
        bed.height = 1e-3 * o.value;
        found = true;
    }
    if (!found) throw usage_error("the run " + folder.string() + " has no '" + definition + "'", "one of: " + names);
    if (bed.at_rest && !std::isfinite(bed.height))
        throw bad_input("'" + definition + "' could not be measured in " + folder.string() + " (" + observables.status + ")",
                        "choose another --definition, or fill in more pellets", {file.string()});
    run.conditions = conditions_of(head.resolved_case);
    return run;
}

/// Repeats of one shape and number may differ in nothing but the seed.
void require_same_conditions(const std::vector<Run>& runs) {
    std::map<std::pair<std::string, double>, const Run*> first;
    for (const Run& run : runs) {
        const auto [at, is_new] = first.emplace(std::make_pair(run.bed.shape, run.bed.pellets), &run);
        if (is_new || at->second->conditions == run.conditions) continue;
        std::istringstream one(at->second->conditions), other(run.conditions);
        std::string a, b;
        while (std::getline(one, a) && std::getline(other, b) && a == b) {
        }
        throw bad_input(fmt::format("{} and {} are no repeats of one case: '{}' against '{}'", at->second->bed.folder, run.bed.folder, a, b),
                        "compare runs that differ in the clump, the number of pellets and the seed only", {run.bed.folder});
    }
}

std::string height_text(const inference::Repeats& r) {
    return r.count > 1 ? fmt::format("{:.2f} ± {:.2f} mm (n = {})", 1e3 * r.mean, 1e3 * r.deviation, r.count) : fmt::format("{:.2f} mm (n = 1)", 1e3 * r.mean);
}

void print_mass_check(const packing::BedReport& report) {
    std::set<std::string> said;
    for (const packing::MassCheck& check : report.mass_checks) {
        const std::string line = fmt::format("{:.2f} mg a pellet by the measured mass and number, {:.2f} mg from mesh and density: {:+.1f} %",
                                             1e6 * check.measured, 1e6 * check.simulated, 100.0 * check.deviation());
        if (!said.insert(line).second) continue;
        print_line("mass check: " + line);
        if (std::abs(check.deviation()) > 0.01)
            print_line(
                "  the pellets are not what was simulated: mend density, size or edges before the heights are read (the same number of lighter pellets is not "
                "the same bed)");
    }
}

std::string csv_of(const packing::BedReport& report) {
    std::string text =
        "pellets,shape,against,first [mm],first_sd [mm],first_n,second [mm],second_sd [mm],second_n,difference [mm],lower [mm],upper [mm],p_difference,margin "
        "[mm],p_equivalence,verdict\n";
    const auto verdict = [](inference::Agreement a) {
        return a == inference::Agreement::equivalent ? "equivalent" : a == inference::Agreement::differs ? "differs" : "undecided";
    };
    const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : std::string(); };
    const auto sample = [&](const inference::Repeats& r) { return fmt::format("{:.6g},{},{}", 1e3 * r.mean, number(1e3 * r.deviation), r.count); };
    for (const auto* list : {&report.against_measurement, &report.between_shapes})
        for (const packing::BedComparison& c : *list)
            text += fmt::format("{:.0f},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.4g},{:.6g},{:.4g},{}\n", c.pellets, c.first, c.second, sample(c.first_height),
                                sample(c.second_height), 1e3 * c.difference.value, 1e3 * c.difference.lower, 1e3 * c.difference.upper, c.difference.p,
                                1e3 * c.equivalence.margin, c.equivalence.p, verdict(c.agreement));
    return text;
}

report::Image chart_of(const std::vector<Run>& runs, const std::vector<MeasuredFill>& fills, const std::string& definition) {
    static const report::Srgb inks[] = {{33, 102, 172}, {178, 24, 43}, {90, 174, 97}, {153, 112, 171}, {230, 140, 30}, {1, 133, 113}};
    report::Chart chart;
    chart.title = "Filled tubes: " + definition;
    chart.horizontal = {"pellets", false};
    chart.vertical = {"bed height (mm)", false};
    const packing::SimulatedBed& one = runs[0].bed;
    double least = one.pellets, most = one.pellets;
    for (const Run& run : runs) {
        least = std::min(least, run.bed.pellets);
        most = std::max(most, run.bed.pellets);
    }
    const auto lower = packing::correlated_beds(0.95 * least, one.pellet_volume, one.tube_diameter);
    const auto upper = packing::correlated_beds(1.05 * most, one.pellet_volume, one.tube_diameter);
    for (std::size_t k = 0; k < lower.size(); ++k) {
        report::ChartSeries line;
        line.name = fmt::format("{}, cylinders (voidage {:.3f})", lower[k].correlation, lower[k].voidage);
        line.points = {{0.95 * least, 1e3 * lower[k].height}, {1.05 * most, 1e3 * upper[k].height}};
        line.colour = {120, 120, 120};
        line.line = true;
        line.dashed = k % 2 == 1;
        line.marker = report::Marker::none;
        chart.series.push_back(line);
    }
    std::map<std::string, report::ChartSeries> shapes;
    for (const Run& run : runs) {
        report::ChartSeries& series = shapes[run.bed.shape];
        series.name = fmt::format("{} ({:.0f} spheres)", run.bed.shape, run.bed.spheres);
        series.points.push_back({run.bed.pellets, 1e3 * run.bed.height});
        series.marker = report::Marker::ring;
    }
    std::size_t ink = 0;
    for (auto& [name, series] : shapes) {
        series.colour = inks[ink++ % std::size(inks)];
        chart.series.push_back(series);
    }
    if (!fills.empty()) {
        report::ChartSeries series;
        series.name = "measured (mean, ± standard deviation)";
        series.colour = {0, 0, 0};
        series.marker = report::Marker::diamond;
        for (const MeasuredFill& fill : fills) {
            const double n = fill.pellets > 0.0 ? fill.pellets : fill.mass / one.pellet_mass;
            series.points.push_back({n, 1e3 * fill.height});
            series.errors.push_back(fill.deviation > 0.0 ? 1e3 * fill.deviation : 0.0);
        }
        chart.series.push_back(series);
    }
    return picture_of_chart(chart, {});
}

void run_compare_tube(const CompareOptions& options) {
    std::vector<MeasuredFill> fills;
    if (!options.measured.empty()) fills = io::read_measured_fills(options.measured, options.unit);
    std::vector<Run> runs;
    for (const std::string& folder : options.runs) runs.push_back(read_run(folder, options.definition));
    require_same_conditions(runs);
    std::vector<packing::SimulatedBed> beds;
    for (const Run& run : runs) beds.push_back(run.bed);
    const packing::BedReport report = packing::compare_beds(beds, fills, {0.01 * options.margin_percent, 0.05});
    print_mass_check(report);
    for (const auto& c : report.against_measurement) {
        print_line(fmt::format("{:.0f} pellets, {}: simulated {}, measured {}", c.pellets, c.first, height_text(c.first_height), height_text(c.second_height)));
        print_line("  " + c.words);
    }
    for (const auto& c : report.between_shapes) {
        print_line(fmt::format("{:.0f} pellets: {} {}, {} {}", c.pellets, c.first, height_text(c.first_height), c.second, height_text(c.second_height)));
        print_line("  against " + c.second + ", " + c.words);
    }
    for (const auto& bed : packing::correlated_beds(beds[0].pellets, beds[0].pellet_volume, beds[0].tube_diameter))
        print_line(
            fmt::format("{} for cylinders: voidage {:.3f}, {:.2f} mm for {:.0f} pellets", bed.correlation, bed.voidage, 1e3 * bed.height, beds[0].pellets));
    for (const std::string& text : report.left_out) print_line("left out: " + text);
    const fs::path folder = options.folder;
    io::prepare_output_folder(folder);
    io::write_text(folder / "comparison.csv", csv_of(report));
    print_written(folder / "comparison.csv", "every comparison with its interval");
    if (options.no_picture) return;
    report::write_png(chart_of(runs, fills, options.definition), folder / "comparison.png");
    print_written(folder / "comparison.png", "heights against the number of pellets, with published correlations");
}

}  // namespace

void add_compare_verb(CLI::App& app) {
    CLI::App* compare = app.add_subcommand("compare", "Simulated against measured: intervals, an equivalence test and a verdict in words");
    compare->require_subcommand(1);
    compare->fallthrough();
    auto options = std::make_shared<CompareOptions>();
    CLI::App* tube = compare->add_subcommand("tube",
                                             "Heights of filled tubes: runs with several seeds against measured repeats, and shape against shape\n"
                                             "  example: pelletlab compare tube heights.csv --runs out/tube-1 out/tube-2 out/tube-3 --margin 2");
    tube->add_option("measured", options->measured,
                     "Table of measured heights (CSV): pellets, mass [g], height [mm], a row a repeat; or mean [mm], sd [mm], n");
    tube->add_option("--unit", options->unit, "Unit of heights whose column states none: mm");
    tube->add_option("--runs", options->runs, "Result folders of pelletlab fill")->required();
    tube->add_option("--definition", options->definition, "Which height: the one that the laboratory measured (docs/observables.md)")->capture_default_str();
    tube->add_option("--margin", options->margin_percent, "Difference, in percent of the height, that would not matter to you")
        ->check(CLI::Range(0.01, 50.0))
        ->capture_default_str();
    tube->add_option("-o,--output", options->folder, "Folder of comparison.csv and comparison.png")->capture_default_str();
    tube->add_flag("--no-picture", options->no_picture, "Write no picture");
    tube->callback([options] { run_compare_tube(*options); });
}

}  // namespace pelletlab::apps
