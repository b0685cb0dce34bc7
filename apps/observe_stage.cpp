#include "apps/observe_stage.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "apps/observe_parts.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "observables/drum.hpp"
#include "observables/pile.hpp"
#include "observables/steady.hpp"
#include "observables/tester.hpp"
#include "report/measured_charts.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

/// Torque on the walls, which a trajectory does not hold: from the observables that the run itself left beside it, with the drive's power.
void add_torque_of_run(Observables& observables, const fs::path& trajectory, double speed) {
    const std::optional<Observables> of_run = observables_beside(trajectory);
    if (!of_run) return;
    for (const Observable& value : of_run->values) {
        if (value.name != "drum_torque" || value.unit != "mN*m") continue;
        observables.values.push_back(value);
        const double to_milliwatt = std::abs(speed);  // of mN m
        observables.values.push_back({"drum_power", "mW", value.value * to_milliwatt, value.standard_error * to_milliwatt, value.window, "drum.torque"});
    }
}

/// Collisions, which happen between frames: rates, energies and spectra that the run itself recorded, over the window that it measured.
void add_collisions_of_run(Observables& observables, const fs::path& trajectory) {
    const std::optional<Observables> of_run = observables_beside(trajectory);
    if (!of_run) {
        print_line("  collision energies are not known: no observables.json of the run lies beside " + trajectory.string());
        return;
    }
    for (const Observable& value : of_run->values)
        if (value.method == "tester.collisions") observables.values.push_back(value);
    for (const Profile& profile : of_run->profiles)
        if (profile.method == "tester.spectrum") observables.profiles.push_back(profile);
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
        request, "tester", opened,
        [&] {
            Observables measured = observables::measure_tester(frames, tester, window);
            if (c)
                add_collisions_of_run(measured, request.trajectory.file);
            else
                print_line("  a table tells no collision energies: they come from forces within contacts that begin and end between its times");
            return measured;
        },
        [&](const Observables& measured, const fs::path& folder) {
            for (const FieldMap& map : measured.maps) write_map(measured, map.name.c_str(), 2.0 * tester.radius, folder / (map.name + ".png"));
            for (const char* energy : {"impact_energy", "normal_dissipation", "total_dissipation"})
                write_chart(report::collision_spectrum(measured, energy), folder / (std::string("spectrum_") + energy + ".png"));
        });
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
