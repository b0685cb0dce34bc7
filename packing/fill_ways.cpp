#include "packing/fill_ways.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "packing/extra_walls.hpp"
#include "packing/wall_motions.hpp"

namespace pelletlab::packing {

namespace {

constexpr double dense = 0.55;      // packing fraction that room is planned with
constexpr double loose = 0.45;      // and that of the loosest bed that must find room
constexpr double clear = 1.1;       // pellets have fallen so many layers before the next ones leave the sieve
constexpr double elbow_room = 1.5;  // sites of the closest lattice a pellet in the sieve's layer
constexpr int most_layers = 6;
constexpr double above_bed = 0.05;   // [m], of the sieve
constexpr double above_rim = 0.005;  // [m], of the funnel's outlet
constexpr int rows_of_a_tap = 16;

double section(const Case& c) {
    return 0.25 * std::numbers::pi * c.tube.diameter * c.tube.diameter;
}

/// Time in which a pellet falls that far [s].
double fall_time(const Case& c, double distance) {
    const double g = c.gravity.norm(), v = c.insertion.fall_speed;
    return (std::sqrt(v * v + 2.0 * g * distance) - v) / g;
}

/// Above the walls of the case. A tube of given height is filled up to insertion.packing_fraction or to its rim; one as high as needed is made higher.
FillPlan plan_cloud(const Case& c, const RigidTemplate& pellet, FillPlan plan) {
    const double radius = 0.5 * c.tube.diameter, lower = top_of_extra_walls(c, radius);
    plan.rounds = {c.pellet.count};
    if (!(c.tube.height > 0.0)) {
        plan.region = upright_region(pellet, c.pellet.count, c.insertion.packing_fraction, radius, lower);
    } else {
        const double wanted = c.pellet.count * pellet.mass_properties.volume / (c.insertion.packing_fraction * section(c)) + 2.0 * pellet.bounding_radius;
        if (lower + 2.0 * pellet.bounding_radius > c.tube.height)
            throw bad_input("the walls of the case leave no room for loose pellets below the rim of the tube", "raise tube.height or leave it at 0");
        plan.region = {InsertionRegion::Axis::z, radius, lower, std::min(lower + wanted, c.tube.height)};
        if (cloud_capacity(pellet, plan.region) < c.pellet.count) plan.region.upper = c.tube.height;
    }
    plan.top = plan.region.upper;
    return plan;
}

FillPlan plan_sieve(const Case& c, const RigidTemplate& pellet, FillPlan plan) {
    if (!(c.gravity.norm() > 0.0)) throw bad_input("nothing falls from a sieve without gravity", "set gravity, or another insertion.way");
    const double sieve = c.insertion.sieve_height > 0.0 ? c.insertion.sieve_height : 2.0 * plan.bed + above_bed;
    const double lowest = plan.bed * dense / loose + 2.0 * pellet.bounding_radius;
    if (sieve < lowest) {
        char text[160];
        std::snprintf(text, sizeof text, "the sieve at %.4g mm would be buried: the bed may rise to %.4g mm", 1e3 * sieve, 1e3 * lowest);
        throw bad_input(text, "raise insertion.sieve_height or leave it at 0, or use fewer pellets");
    }
    double each = 0.0, most = 0.0;
    // What leaves the sieve together lies in one layer of bounding spheres, or in a few where the rate asks for more.
    for (int layers = 1; layers <= most_layers; ++layers) {
        const double thickness = 2.05 * layers * pellet.bounding_radius;
        plan.region = {InsertionRegion::Axis::z, 0.5 * c.tube.diameter, sieve, sieve + thickness};
        plan.round_time = fall_time(c, clear * thickness);
        each = c.insertion.sieve_rate * plan.round_time, most = cloud_capacity(pellet, plan.region) / elbow_room;
        if (each <= most) break;
    }
    plan.top = plan.region.upper;
    if (each > most) {
        char text[160];
        std::snprintf(text, sizeof text, "the sieve cannot let %.0f pellets a second through a tube of %.4g mm: at most %.0f", c.insertion.sieve_rate,
                      1e3 * c.tube.diameter, most / plan.round_time);
        throw bad_input(text, "lower insertion.sieve_rate, or give the pellets an insertion.fall_speed");
    }
    // Whole pellets, at the rate in the mean: after k rounds ⌈k · each⌉ have fallen.
    double fallen = 0.0;
    std::uint32_t left = c.pellet.count;
    while (left > 0) {
        const auto now = std::min(left, static_cast<std::uint32_t>(std::ceil(fallen + each) - std::ceil(fallen)));
        fallen += each;
        left -= now;
        plan.rounds.push_back(now);
    }
    return plan;
}

FillPlan plan_batches(const Case& c, const RigidTemplate& pellet, FillPlan plan) {
    const std::uint32_t batches = std::min(c.insertion.batches, c.pellet.count);
    for (std::uint32_t k = 0; k < batches; ++k) plan.rounds.push_back(c.pellet.count / batches + (k < c.pellet.count % batches ? 1 : 0));
    plan.region =
        upright_region(pellet, plan.rounds.front(), c.insertion.packing_fraction, 0.5 * c.tube.diameter, top_of_extra_walls(c, 0.5 * c.tube.diameter));
    plan.top = plan.bed * dense / loose + 4.0 * pellet.bounding_radius + plan.region.upper;  // the last batch above a loose bed
    return plan;
}

FillPlan plan_funnel(const Case& c, const RigidTemplate& pellet, FillPlan plan) {
    plan.rounds = {c.pellet.count};
    plan.top = plan.bed * dense / loose + 4.0 * pellet.bounding_radius;
    const double rim = c.tube.height > 0.0 ? c.tube.height : plan.top;
    plan.outlet = c.funnel.outlet_height > 0.0 ? c.funnel.outlet_height : rim + above_rim;
    Funnel funnel = make_funnel(c, pellet, c.tube.material, plan.outlet);
    plan.region = funnel.region;
    plan.walls = std::move(funnel.walls);
    return plan;
}

void move_tube(solver::Simulation& simulation, const std::vector<solver::MotionRow>& table) {
    change_motions(
        simulation, [](const std::string& wall) { return wall != "funnel" && wall != "shutter"; }, [&](solver::WallMotion& motion) { motion.table = table; });
}

Stage watched(std::string name, double duration, const Case& c) {
    Stage stage;
    stage.name = std::move(name);
    stage.duration = duration;
    stage.frame_interval = c.output.frame_interval;
    stage.watch_interval = 0.001;
    return stage;
}

}  // namespace

FillPlan plan_fill(const Case& c, const RigidTemplate& pellet) {
    FillPlan plan;
    plan.bed = c.pellet.count * pellet.mass_properties.volume / (dense * section(c));
    const std::string& way = c.insertion.way;
    plan = way == "sieve"     ? plan_sieve(c, pellet, std::move(plan))
           : way == "batches" ? plan_batches(c, pellet, std::move(plan))
           : way == "funnel"  ? plan_funnel(c, pellet, std::move(plan))
                              : plan_cloud(c, pellet, std::move(plan));
    if (c.tube.height > 0.0 && plan.top > c.tube.height * (1.0 + 1e-9)) {
        char text[160];
        std::snprintf(text, sizeof text, "the tube is %.4g mm high and this way of filling needs %.4g mm", 1e3 * c.tube.height, 1e3 * plan.top);
        throw bad_input(text, "raise tube.height or leave it at 0, use fewer pellets or more batches, or lower insertion.sieve_height");
    }
    return plan;
}

void add_round(solver::Simulation& simulation, const Case& c, const FillPlan& plan, std::size_t round) {
    const std::uint32_t count = plan.rounds[round];
    if (count == 0) return;
    const RigidTemplate& pellet = simulation.definition().templates.front();
    InsertionRegion region = plan.region;
    double top = 0.0;
    for (const Vec3& p : simulation.bodies().position) top = std::max(top, p.z() + pellet.bounding_radius);
    if (plan.round_time > 0.0 && top > region.lower)
        throw bad_input("a pellet has come up into the sieve where the next ones begin to fall", "raise insertion.sieve_height");
    if (plan.round_time == 0.0 && round > 0) {  // a batch falls on the bed that lies there
        const double shift = top + pellet.bounding_radius - region.lower;
        region.lower += shift, region.upper += shift;
    }
    const double g = c.gravity.norm();
    const Vec3 velocity = g > 0.0 ? Vec3(c.gravity * (c.insertion.fall_speed / g)) : Vec3(0.0, 0.0, -c.insertion.fall_speed);
    const std::uint64_t seed = round == 0 ? c.seed : RandomStream(c.seed, (std::uint64_t{1} << 40) + round).bits();
    simulation.add_bodies(loose_cloud(pellet, count, region, seed, velocity));
}

SettleStatus fill(Course& course, solver::Simulation& simulation, const Case& c, const FillPlan& plan) {
    SettleStatus status = SettleStatus::at_rest;
    for (std::size_t round = 0; round < plan.rounds.size(); ++round) {
        if (round > 0 && !course.is_catching_up()) add_round(simulation, c, plan, round);
        const std::string which = plan.rounds.size() > 1 ? " (" + std::to_string(round + 1) + " of " + std::to_string(plan.rounds.size()) + ")" : "";
        if (plan.round_time > 0.0) {
            Stage rain = watched("raining" + which, plan.round_time, c);
            course.run(rain);
        } else {
            status = settle(course, simulation, c, c.output.frame_interval, "settling" + which);
        }
    }
    if (plan.round_time > 0.0) status = settle(course, simulation, c, c.output.frame_interval);
    if (plan.outlet > 0.0) {
        if (!course.is_catching_up()) open_shutter(simulation, c.funnel);
        Stage opening = watched("opening the funnel", c.funnel.shutter_time, c);
        course.run(opening);
        status = settle(course, simulation, c, c.output.frame_interval, "pouring");
    }
    return status;
}

SettleStatus tap(Course& course, solver::Simulation& simulation, const Case& c, SettleStatus status) {
    if (c.insertion.taps == 0) return status;
    const double period = 1.0 / c.insertion.tap_frequency;
    std::vector<solver::MotionRow> swing;
    for (int k = 0; k <= rows_of_a_tap; ++k) {
        const double share = static_cast<double>(k) / rows_of_a_tap;
        const double lift = k == 0 || k == rows_of_a_tap ? 0.0 : 0.5 * c.insertion.tap_amplitude * (1.0 - std::cos(2.0 * std::numbers::pi * share));
        swing.push_back({share * period, lift * Vec3::UnitZ(), 0.0});
    }
    for (std::uint32_t k = 0; k < c.insertion.taps; ++k) {
        if (!course.is_catching_up()) move_tube(simulation, swing);
        const std::string which = " (" + std::to_string(k + 1) + " of " + std::to_string(c.insertion.taps) + ")";
        Stage one = watched("tapping" + which, period, c);
        course.run(one);
        status = settle(course, simulation, c, c.output.frame_interval, "settling after a tap" + which);
    }
    return status;
}

}  // namespace pelletlab::packing
