#include "apps/observe_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "apps/print_observables.hpp"
#include "apps/stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/files.hpp"
#include "io/observables_file.hpp"
#include "observables/bed.hpp"
#include "observables/drum.hpp"
#include "observables/lying_bed.hpp"
#include "observables/pile.hpp"
#include "observables/steady.hpp"
#include "observables/tester.hpp"
#include "report/pictures.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

double given(const std::string& text, Dimension dimension, double otherwise) {
    return text.empty() ? otherwise : parse_quantity(text, dimension);
}

/// A number that a run of our own knows and a table does not.
double needed(const std::string& text, Dimension dimension, const std::optional<double>& of_case, const char* option, const char* what) {
    if (!text.empty()) return parse_quantity(text, dimension);
    if (!of_case) throw usage_error(fmt::format("{} is not known", what), fmt::format("give it with {}", option));
    return *of_case;
}

const Case* case_of(const OpenedTrajectory& opened, Rig rig) {
    if (!opened.resolved_case) return nullptr;
    if (opened.resolved_case->rig != rig)
        throw usage_error("this is a run of a " + rig_name(opened.resolved_case->rig),
                          "observe it with: pelletlab observe " + rig_name(opened.resolved_case->rig));
    return &*opened.resolved_case;
}

TimeWindow window_of(const ObserveRequest& request, const FrameSource& frames, double begin) {
    if (frames.frame_count() == 0) throw bad_input("the trajectory holds no frame", "run the case again", {request.trajectory.file.string()});
    TimeWindow window{given(request.from, dimension::time, begin), given(request.until, dimension::time, frames.time(frames.frame_count() - 1))};
    if (!(window.begin <= window.end)) throw usage_error("the window ends before it begins", "give --from a time before --until");
    return window;
}

using Pictures = std::function<void(const Observables&, const fs::path& folder)>;

/// Measures unless the folder holds the result of the same file and options already; writes observables.json and pictures together.
void finish(const ObserveRequest& request, const char* rig, const OpenedTrajectory& opened, const std::function<Observables()>& measure,
            const Pictures& pictures) {
    const Stopwatch stopwatch;
    StageKey key;
    key.verb = std::string("observe ") + rig;
    key.settings = request.settings();
    key.inputs = opened.inputs;
    const fs::path folder = request.output.empty() ? fs::path("observed") : request.output;
    if (!request.force && stage_is_finished(folder, key)) {
        print_line(folder.string() + " is up to date (same trajectory, same options, same program)");
        return;
    }
    StageFolder stage(folder);
    Observables observables = measure();
    throw_if_interrupted();
    const std::uint64_t seed = observables.provenance.seed;
    observables.provenance = provenance_of(key, seed);
    print_observables(observables);
    io::write_observables(observables, stage.unfinished() / "observables.json");
    if (request.pictures && pictures) pictures(observables, stage.unfinished());
    throw_if_interrupted();
    std::vector<std::string> written;
    for (const auto& entry : fs::directory_iterator(stage.unfinished()))
        if (entry.is_regular_file()) written.push_back(entry.path().filename().string());
    std::sort(written.begin(), written.end());
    stage.finish(key);
    for (const std::string& file : written) print_written(folder / file, file.ends_with(".png") ? "picture of a map" : "measured values, profiles and maps");
    print_line("  took " + duration_text(stopwatch.seconds()));
}

/// Torque on the walls, which a trajectory does not hold: from the observables that the run itself left beside it, with the drive's power.
void add_torque_of_run(Observables& observables, const fs::path& trajectory, double speed) {
    const fs::path file = trajectory.parent_path() / "observables.json";
    if (!fs::exists(file)) return;
    for (const Observable& value : io::read_observables(file).values) {
        if (value.name != "drum_torque" || value.unit != "mN*m") continue;
        observables.values.push_back(value);
        const double to_milliwatt = std::abs(speed);  // of mN m
        observables.values.push_back({"drum_power", "mW", value.value * to_milliwatt, value.standard_error * to_milliwatt, value.window, "drum.torque"});
    }
}

void write_map(const Observables& observables, const char* map, double circle, const fs::path& file) {
    for (const FieldMap& one : observables.maps)
        if (one.name == map) {
            report::PictureSettings settings;
            settings.circle_diameter = circle;
            report::write_png(report::picture_of_map(observables, map, settings), file);
        }
}

}  // namespace

std::string ObserveRequest::settings() const {
    std::string text = trajectory.settings();
    for (const std::string* option :
         {&diameter, &length, &speed, &floor, &ceiling, &baffle_height, &baffle_angle, &from, &until, &grid, &view_depth, &camera_grid, &slab})
        text += *option + "|";
    return text + fmt::format("{}|{}|{}", pellets_each, pictures, lying);
}

namespace {

void observe_lying_tube(const ObserveRequest& request, const OpenedTrajectory& opened, const Case* c) {
    const auto known = [c](double TubeRig::*member) { return c ? std::optional(c->tube.*member) : std::nullopt; };
    observables::LyingGeometry tube;
    tube.radius = 0.5 * needed(request.diameter, dimension::length, known(&TubeRig::diameter), "--diameter \"240 mm\"", "the tube's inner diameter");
    tube.length = needed(request.length, dimension::length, known(&TubeRig::height), "--length \"90 mm\"", "the lying tube's inner length");
    tube.height_grid = given(request.grid, dimension::length, c ? c->measurement.height_grid : tube.height_grid);
    finish(request, "tube", opened, [&] { return observables::measure_lying_bed(*opened.frames, tube); }, {});
}

/// Angle of the baffle [rad] at the last frame of a run of our own: where it was put, and how far its wall has turned since.
std::optional<double> baffle_angle_of_run(const Case* c, const FrameSource& frames) {
    if (!c || frames.frame_count() == 0) return std::nullopt;
    const Frame last = frames.frame(frames.frame_count() - 1);
    if (last.wall_poses.empty()) return std::nullopt;
    const Quat& turn = last.wall_poses.back().orientation;  // all walls turn together, about y
    const double angle = 2.0 * std::atan2(turn.y(), turn.w());
    return c->tester.baffle_start + (c->tester.speed < 0.0 ? -angle : angle);
}

/// What a run measured: whole turns, or all of a measurement shorter than one; in whole steps.
double measured_time(const Case& c) {
    const double turn = 2.0 * std::numbers::pi / std::abs(c.tester.speed), turns = std::floor(c.time.measure / turn + 1e-9);
    return std::round((turns >= 1.0 ? turns * turn : c.time.measure) / c.time.step) * c.time.step;
}

}  // namespace

void observe_tester(const ObserveRequest& request) {
    const OpenedTrajectory opened = open_for_observation(request.trajectory);
    if (!opened.depth_known)
        throw bad_input("the table has no coordinate along the tester's axis", "a tester needs all three coordinates", {request.trajectory.file.string()});
    const Case* c = case_of(opened, Rig::tester);
    const FrameSource& frames = *opened.frames;
    const auto known = [c](double TesterRig::*member) { return c ? std::optional(c->tester.*member) : std::nullopt; };
    observables::TesterGeometry tester;
    tester.radius = 0.5 * needed(request.diameter, dimension::length, known(&TesterRig::diameter), "--diameter \"254 mm\"", "the tester's inner diameter");
    tester.length = needed(request.length, dimension::length, known(&TesterRig::length), "--length \"152 mm\"", "the tester's inner length");
    tester.baffle_height =
        needed(request.baffle_height, dimension::length, known(&TesterRig::baffle_height), "--baffle-height \"51 mm\"", "the height of the baffle");
    tester.rotation_speed = needed(request.speed, dimension::rotation_speed, known(&TesterRig::speed),
                                   "--speed \"40 rpm\" (negative when it turns the other way)", "the tester's speed");
    const std::optional<double> of_run = request.baffle_angle.empty() ? baffle_angle_of_run(c, frames) : std::nullopt;
    tester.baffle_angle = needed(request.baffle_angle, dimension::angle, of_run, "--baffle-angle \"0 deg\", what it was at time 0", "the baffle's angle");
    const double end = frames.frame_count() > 0 ? frames.time(frames.frame_count() - 1) : 0.0;
    tester.angle_time = of_run ? end : 0.0;
    tester.grid = given(request.grid, dimension::length, c ? c->measurement.velocity_grid : tester.grid);
    const TimeWindow window = window_of(request, frames, c ? end - measured_time(*c) : frames.frame_count() > 0 ? frames.time(0) : 0.0);
    finish(
        request, "tester", opened, [&] { return observables::measure_tester(frames, tester, window); },
        [&](const Observables& measured, const fs::path& folder) {
            for (const FieldMap& map : measured.maps) write_map(measured, map.name.c_str(), 2.0 * tester.radius, folder / (map.name + ".png"));
        });
}

void observe_tube(const ObserveRequest& request) {
    const OpenedTrajectory opened = open_for_observation(request.trajectory);
    const Case* c = case_of(opened, Rig::tube);
    if (c ? c->tube.lying : request.lying) {
        observe_lying_tube(request, opened, c);
        return;
    }
    observables::TubeGeometry tube;
    tube.radius = 0.5 * needed(request.diameter, dimension::length, c ? std::optional(c->tube.diameter) : std::nullopt, "--diameter \"52 mm\"",
                               "the tube's inner diameter");
    tube.floor = given(request.floor, dimension::length, 0.0);
    tube.height_grid = given(request.grid, dimension::length, c ? c->measurement.height_grid : tube.height_grid);
    finish(request, "tube", opened, [&] { return observables::measure_tube_bed(*opened.frames, tube); }, {});
}

void observe_pile(const ObserveRequest& request) {
    const OpenedTrajectory opened = open_for_observation(request.trajectory);
    observables::PileGeometry pile;
    pile.plate = given(request.floor, dimension::length, pile.plate);
    pile.ceiling = given(request.ceiling, dimension::length, pile.ceiling);
    pile.height_grid = given(request.grid, dimension::length, pile.height_grid);
    finish(
        request, "pile", opened, [&] { return observables::measure_pile(*opened.frames, pile); },
        [](const Observables& measured, const fs::path& folder) { write_map(measured, "pile_top_surface", 0.0, folder / "top-surface.png"); });
}

void observe_drum(const ObserveRequest& request) {
    const OpenedTrajectory opened = open_for_observation(request.trajectory);
    const Case* c = case_of(opened, Rig::drum);
    const auto known = [c](double DrumRig::*member) { return c ? std::optional(c->drum.*member) : std::nullopt; };
    observables::DrumGeometry drum;
    drum.radius = 0.5 * needed(request.diameter, dimension::length, known(&DrumRig::diameter), "--diameter \"240 mm\"", "the drum's inner diameter");
    drum.length = needed(request.length, dimension::length, known(&DrumRig::length), "--length \"90 mm\"", "the drum's inner length");
    drum.rotation_speed = needed(request.speed, dimension::rotation_speed, known(&DrumRig::speed), "--speed \"20 rpm\" (negative when it turns the other way)",
                                 "the drum's speed");
    drum.velocity_grid = given(request.grid, dimension::length, c ? c->measurement.velocity_grid : drum.velocity_grid);
    drum.view_depth = given(request.view_depth, dimension::length, 0.0);
    drum.camera_grid = given(request.camera_grid, dimension::length, drum.camera_grid);
    drum.pellets_each = request.pellets_each;
    drum.depth_known = opened.depth_known;
    if (!request.slab.empty()) {
        const std::size_t comma = request.slab.find(',');
        if (comma == std::string::npos) throw usage_error("--slab needs two places along the axis", "for instance --slab \"-5 mm, 5 mm\"");
        drum.slab_begin = parse_quantity(std::string_view(request.slab).substr(0, comma), dimension::length);
        drum.slab_end = parse_quantity(std::string_view(request.slab).substr(comma + 1), dimension::length);
        if (!(drum.slab_begin < drum.slab_end)) throw usage_error("the slab ends before it begins", "give the smaller place first");
    }
    const FrameSource& frames = *opened.frames;
    const double end = frames.frame_count() > 0 ? frames.time(frames.frame_count() - 1) : 0.0;
    const TimeWindow window = window_of(request, frames, c ? end - c->time.measure : frames.frame_count() > 0 ? frames.time(0) : 0.0);
    finish(
        request, "drum", opened,
        [&] {
            Observables measured = observables::measure_drum(frames, drum, window);
            if (const Observable onset = observables::drum_steady_onset(frames); std::isfinite(onset.value)) {
                measured.values.push_back(onset);
                // An onset that the window's begin does not reach within two errors.
                if (measured.status == "complete" && onset.value > window.begin + 2.0 * onset.standard_error) measured.status = "not steady";
            }
            if (c) add_torque_of_run(measured, request.trajectory.file, drum.rotation_speed);
            return measured;
        },
        [&](const Observables& measured, const fs::path& folder) {
            write_map(measured, "speed", 2.0 * drum.radius, folder / "velocity-map.png");
            write_map(measured, "camera_speed", 2.0 * drum.radius, folder / "camera-velocity-map.png");
        });
}

}  // namespace pelletlab::apps
