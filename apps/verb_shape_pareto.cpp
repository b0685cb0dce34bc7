// pelletlab shape pareto: accuracy against DEM cost over numbers of spheres, modes and methods. Every point is a clump file; what is there is not made again.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>

#include "apps/body_options.hpp"
#include "apps/shape_report.hpp"
#include "apps/shape_settings.hpp"
#include "apps/shape_stage.hpp"
#include "apps/shape_verbs.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/files.hpp"
#include "report/chart.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

struct ParetoOptions {
    BodyOptions body;
    std::string folder = "pareto", density = "1800 kg/m^3";
    std::vector<std::uint32_t> counts{6, 12, 24, 42, 82, 130, 200};
    std::vector<std::string> modes{"mean", "minimax", "flat"}, methods{"all"};
    std::uint64_t seed = 1;
    bool force = false;
};

/// One clump of the sweep: what to make, and what came out.
struct ParetoPoint {
    std::string method, mode;  ///< mode: of the fit, else empty
    bool matched = false;
    ShapeRequest request;
    ClumpTemplate clump;
    double cost = 0.0;  ///< / that of Shape 2
    shapegen::DemCost dem;
    bool on_front = false;
};

std::vector<std::string> methods_of(const ParetoOptions& options, const TriangleMesh& body) {
    std::vector<std::string> ids;
    for (const std::string& wanted : options.methods) {
        if (wanted == "none") continue;
        if (wanted != "all") {
            ids.push_back(wanted);
            continue;
        }
        for (const NamedMethod& method : all_methods())
            if (method.id != fit_method && (!is_study_shape(method.id) || is_study_cylinder(body))) ids.push_back(method.id);
    }
    return ids;
}

std::vector<ParetoPoint> plan(const ParetoOptions& options, const TriangleMesh& body) {
    std::vector<ParetoPoint> points;
    const fs::path folder = fs::path(options.folder) / "clumps";
    const auto add = [&](const std::string& method, const std::string& mode, bool matched, std::uint32_t count) {
        ParetoPoint point{method, mode, matched, {}, {}, 0.0, {}, false};
        ShapeRequest& request = point.request;
        request.body = body_request(options.body);
        request.method = method;
        request.volume_matched = matched;
        request.settings.density = parse_quantity(options.density, dimension::density);
        request.settings.fit.seed = options.seed;
        request.settings.fit.sphere_count = count;
        request.settings.measure_surface = false;
        if (!mode.empty()) request.settings.fit.mode = fit_modes().at(mode);
        request.picture = false;
        request.force = options.force;
        request.output = folder / (fmt::format("{}{}{}", mode.empty() ? method : "fit-" + mode,
                                               is_study_shape(method) ? std::string() : fmt::format("-{}", count), matched ? "-matched" : "") +
                                   ".clump.toml");
        points.push_back(std::move(point));
    };
    for (const std::string& mode : options.modes) {
        for (const std::uint32_t count : options.counts) add(fit_method, mode, false, count);
    }
    for (const std::string& method : methods_of(options, body))
        for (const bool matched : {false, true}) {
            if (is_study_shape(method))
                add(method, "", matched, 1);
            else
                for (const std::uint32_t count : options.counts) add(method, "", matched, count);
        }
    return points;
}

/// Makes or reads every clump; those that a method cannot make are told and left out.
std::vector<ParetoPoint> make_all(std::vector<ParetoPoint> points, const BodyOnDisk& body, double density) {
    const double unit = shapegen::dem_cost_of_shape_2(density).cost;
    ProgressPrinter printer;
    const ProgressSink tell = printer.sink();
    const auto begin = std::chrono::steady_clock::now();
    std::vector<ParetoPoint> made;
    std::map<std::string, std::string> refused;
    std::size_t there = 0, done = 0;
    for (ParetoPoint& point : points) {
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const auto fresh = static_cast<double>(done - there);
        tell({"clumps", static_cast<double>(done), static_cast<double>(points.size()), "clumps", seconds > 0.0 ? 60.0 * fresh / seconds : 0.0, "a minute",
              stem_of(point.request.output).filename().string()});
        ++done;
        if (refused.count(point.method) != 0) continue;
        try {
            QuietClump quiet = ensure_clump(point.request, body, {});
            there += quiet.was_there ? 1 : 0;
            point.clump = std::move(quiet.clump);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::bad_input || point.method == fit_method) throw;
            refused[point.method] = error.problem();
            continue;
        }
        point.dem = shapegen::dem_cost(point.clump.rigid.spheres, point.clump.rigid.mass_properties);
        point.cost = point.dem.cost / unit;
        made.push_back(std::move(point));
    }
    printer.finish();
    for (const auto& [method, problem] : refused) print_line("  left out: " + find_method(method).name + ": " + problem);
    if (there > 0) print_line(fmt::format("  {} of {} clumps were there already", there, made.size()));
    return made;
}

void mark_front(std::vector<ParetoPoint>& points) {
    for (ParetoPoint& point : points)
        point.on_front = std::none_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
            const double a = other.clump.quality.both.rms, b = point.clump.quality.both.rms;
            return other.cost <= point.cost && a <= b && (other.cost < point.cost || a < b);
        });
}

std::string csv_of(const std::vector<ParetoPoint>& points) {
    std::string text =
        "method,mode,volume_matched,spheres,cost_of_shape_2,time_step [s],contacts_mean,contacts_most,mean [mm],rms [mm],max "
        "[mm],volume_error,worst_inertia_error,"
        "symmetric_difference,on_front,clump\n";
    for (const ParetoPoint& p : points) {
        const FitQuality& q = p.clump.quality;
        text += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{}\n", p.method, p.mode, p.matched ? 1 : 0,
                            p.clump.rigid.spheres.size(), p.cost, p.dem.time_step, p.dem.contacts_mean, p.dem.contacts_most, 1e3 * q.both.mean,
                            1e3 * q.both.rms, 1e3 * q.both.max, q.volume_error, worst_inertia_error(q), q.symmetric_difference, p.on_front ? 1 : 0,
                            "clumps/" + p.request.output.filename().string());
    }
    return text;
}

report::Image chart_of(const std::vector<ParetoPoint>& points, const std::string& title) {
    using report::Marker;
    report::Chart chart;
    chart.title = title;
    chart.horizontal = {"DEM cost (1: the study's Shape 2)", true};
    chart.vertical = {"rms distance of the surfaces, both ways (mm)", true};
    static const std::map<std::string, report::Srgb> inks{{"mean", {178, 24, 43}},     {"minimax", {214, 96, 77}},  {"flat", {230, 140, 30}},
                                                          {"inside", {150, 60, 120}},  {"outside", {110, 40, 160}}, {"openvdb", {33, 102, 172}},
                                                          {"favier", {120, 120, 120}}, {"ferellec", {27, 120, 55}}, {"euclidean", {90, 160, 200}}};
    std::vector<std::string> keys;
    std::map<std::string, report::ChartSeries> series;
    for (const ParetoPoint& p : points) {
        const bool study = is_study_shape(p.method);
        const std::string key = (study ? "study" : p.mode.empty() ? p.method : p.mode) + (p.matched ? "+" : "");
        if (series.count(key) == 0) {
            keys.push_back(key);
            report::ChartSeries& one = series[key];
            one.name = study ? "Shapes 1-4" : p.mode.empty() ? find_method(p.method).id : "fit, " + p.mode;
            if (p.matched) one.name += ", matched";
            const auto ink = inks.find(p.mode.empty() ? p.method : p.mode);
            one.colour = study || ink == inks.end() ? report::Srgb{20, 20, 20} : ink->second;
            one.line = !study;
            one.dashed = p.mode.empty() && p.matched;
            one.marker = study ? (p.matched ? Marker::ring : Marker::square) : p.mode.empty() ? (p.matched ? Marker::ring : Marker::cross) : Marker::disc;
        }
        report::ChartSeries& one = series[key];
        one.points.push_back({p.cost, 1e3 * p.clump.quality.both.rms});
        if (study) one.labels.push_back(p.method.substr(5));
        if (p.mode == "mean") one.labels.push_back(std::to_string(p.clump.rigid.spheres.size()));
    }
    for (auto key = keys.rbegin(); key != keys.rend(); ++key) chart.series.push_back(series[*key]);  // ours last, on top
    return report::picture_of_chart(chart, {});
}

void print_front(const std::vector<ParetoPoint>& points) {
    std::vector<ParetoPoint> front;
    for (const ParetoPoint& p : points)
        if (p.on_front) front.push_back(p);
    std::sort(front.begin(), front.end(), [](const ParetoPoint& a, const ParetoPoint& b) { return a.cost < b.cost; });
    std::vector<std::vector<std::string>> rows{{"nothing is both cheaper and better than", "spheres", "DEM cost", "mean", "rms", "max"}};
    for (const ParetoPoint& p : front)
        rows.push_back({p.mode.empty() ? find_method(p.method).name + (p.matched ? ", volume-matched" : "") : "fit, " + p.mode,
                        std::to_string(p.clump.rigid.spheres.size()), fmt::format("{:.2f}", p.cost), millimetres(p.clump.quality.both.mean),
                        millimetres(p.clump.quality.both.rms), millimetres(p.clump.quality.both.max)});
    print_table(rows);
}

void run_pareto(const ParetoOptions& options) {
    const Stopwatch stopwatch;
    const double density = parse_quantity(options.density, dimension::density);
    if (!(density > 0.0)) throw bad_input("the particle density is not positive", "give it like 1800 kg/m^3");
    for (const std::string& mode : options.modes)
        if (fit_modes().count(mode) == 0) throw usage_error("there is no mode '" + mode.substr(0, 40) + "'", "known: mean, minimax, inside, outside, flat");
    for (const std::string& method : options.methods)
        if (method != "all" && method != "none" && find_method(method).id == fit_method)
            throw usage_error("the fit takes part anyway", "name other methods, all or none");
    const fs::path folder = options.folder;
    BodyOnDisk body(body_request(options.body), folder / "clumps" / "body");
    std::vector<ParetoPoint> points = plan(options, body.mesh());
    io::prepare_output_folder(folder / "clumps");
    body.keep();
    points = make_all(std::move(points), body, density);
    mark_front(points);
    print_front(points);
    io::write_text(folder / "pareto.csv", csv_of(points));
    print_written(folder / "pareto.csv", fmt::format("{} clumps", points.size()));
    report::write_png(chart_of(points, "Accuracy and cost of clumps"), folder / "pareto.png");
    print_written(folder / "pareto.png", "rms distance against DEM cost");
    print_line(fmt::format("  took {}, peak memory {:.0f} MB", duration_text(stopwatch.seconds()), peak_memory_megabytes()));
}

}  // namespace

void add_shape_pareto(CLI::App& shape) {
    auto options = std::make_shared<ParetoOptions>();
    CLI::App* verb = shape.add_subcommand(
        "pareto",
        "Sweep numbers of spheres, modes and methods: error against DEM cost as table and chart. An interrupted sweep goes on where it was\n"
        "  example: pelletlab shape pareto --body cylinder --counts 12,24,42,82 -o pareto");
    add_body_options(*verb, options->body);
    verb->add_option("--counts", options->counts, "Numbers of spheres")->delimiter(',')->check(CLI::Range(1, 2000))->capture_default_str();
    verb->add_option("--modes", options->modes, "Modes of the fit: mean, minimax, inside, outside, flat")->delimiter(',')->capture_default_str();
    verb->add_option("--methods", options->methods, "Other methods beside: all, none, or shape1 … shape4, openvdb, favier, ferellec, euclidean")
        ->delimiter(',')
        ->capture_default_str();
    verb->add_option("--density", options->density, "Particle density, with unit")->capture_default_str();
    verb->add_option("--seed", options->seed, "Seed of the search")->capture_default_str();
    verb->add_option("-o,--output", options->folder, "Folder: pareto.csv, pareto.png, and every clump")->capture_default_str();
    verb->add_flag("--force", options->force, "Make every clump again");
    verb->callback([options, &shape, verb] {
        refuse_options_of_shape(shape, *verb);
        run_pareto(*options);
    });
}

}  // namespace pelletlab::apps
