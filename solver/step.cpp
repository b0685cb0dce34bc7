// One time step, as a list of stages.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "solver/detail/motion.hpp"
#include "solver/detail/state.hpp"

namespace pelletlab::solver {

namespace {

using detail::body_grain;
using detail::sum_grain;
using detail::wall_grain;

/// Adds the time since the last lap to a stage.
class StopWatch {
public:
    explicit StopWatch(std::array<double, 6>& seconds) : seconds_(seconds) {}
    void lap(std::size_t stage) {
        const auto now = std::chrono::steady_clock::now();
        seconds_[stage] += std::chrono::duration<double>(now - last_).count();
        last_ = now;
    }

private:
    std::array<double, 6>& seconds_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

void Simulation::step() {
    State& s = *state_;
    const detail::StepClock clock{s.definition.time_step, s.definition.time_step, static_cast<std::uint32_t>(s.steps + 1)};
    s.view_is_current = false;
    StopWatch watch(s.stage_seconds);
    const double furthest2 = s.kick_and_drift_bodies();
    watch.lap(0);
    s.move_walls();
    watch.lap(1);
    s.find_neighbours_if_needed(furthest2);
    watch.lap(2);
    s.compute_pair_forces(clock);
    watch.lap(3);
    s.compute_wall_forces(clock);
    s.compute_body_forces();
    watch.lap(4);
    s.gather_forces_and_kick(0.5 * s.definition.time_step);
    s.sum_wall_loads();
    s.book_contacts();
    s.book_work();
    s.record_events();
    watch.lap(5);
}

void Simulation::advance(std::uint64_t count) {
    for (std::uint64_t k = 0; k < count; ++k) step();
}

namespace {

/// The error for a body that left the domain or is not a number any more.
Error lost_body(const Simulation::State& s, std::size_t i) {
    const Vec3 p = s.bodies.position(i), v = s.bodies.velocity(i);
    std::ostringstream text;
    text << "body " << s.bodies.id(i);
    if (p.allFinite() && s.bodies.angular_momentum(i).allFinite()) {
        text << " left the domain at (" << p.x() << ", " << p.y() << ", " << p.z() << ") m with a speed of " << v.norm() << " m/s";
    } else {
        const Vec3 d = s.kinematics.size() > i ? s.bodies.force(i) : Vec3::Zero();
        text << " has a position or a spin that is not a number (last force " << d.norm() << " N)";
    }
    text << ", time " << s.time() << " s, step " << s.steps;
    const double length = s.templates[s.bodies.template_of(i)].bounding_radius;
    const bool fast = !(v.norm() * s.definition.time_step < 0.05 * length);
    return numerical_failure(text.str(), fast
                                             ? "the speed says that contacts became unstable: use a smaller time step (advise_time_step), or check that bodies "
                                               "do not overlap at the start"
                                             : "the speed is a normal one: look for an opening in the walls, or give a larger domain");
}

}  // namespace

double Simulation::State::kick_and_drift_bodies() {
    const std::size_t n = bodies.size();
    detail::DriftSettings settings{definition.time_step, {}, {}};
    for (int k = 0; k < 3; ++k) settings.low[k] = domain.min()[k], settings.high[k] = domain.max()[k];
    const detail::BodyArrays arrays = bodies.arrays(constants.data(), kinematics.data());
    drift_results.resize((n + body_grain - 1) / body_grain);
    parallel_blocks(n, body_grain, [&](std::size_t begin, std::size_t end) {
        detail::DriftResult& result = drift_results[begin / body_grain];
        const std::size_t padded_end = detail::padded_count(end);
        kernels->drift(arrays, begin, padded_end, settings, result);
        if (result.first_lost >= end) result.first_lost = n;
    });
    ++steps;
    double furthest2 = 0.0;
    std::size_t lost = n;
    for (const detail::DriftResult& result : drift_results) {
        furthest2 = std::max(furthest2, result.furthest2);
        lost = std::min(lost, result.first_lost);
    }
    if (lost < n) throw lost_body(*this, lost);
    return furthest2;
}

void Simulation::State::move_walls() {
    for (detail::Wall& wall : walls) {
        const Vec3 before = wall.pose.position;
        const double angle = wall.place.angle;
        detail::move_wall(wall, steps, definition.time_step);
        const double shift = (wall.pose.position - before).norm();
        const double furthest = (before - domain.min()).cwiseAbs().cwiseMax((before - domain.max()).cwiseAbs()).norm() + shift;  // that a body can be
        wall.path += 1.000001 * (shift + std::abs(wall.place.angle - angle) * furthest);
    }
}

void Simulation::State::find_neighbours_if_needed(double furthest2) {
    if (!(furthest2 > 0.25 * pairs.skin * pairs.skin)) return;
    pairs.adapt_skin(steps);
    const bool scattered = pairs.spread > 1.25 * pairs.ordered_spread;
    if (scattered) order_bodies();
    detail::rebuild_pairs(pairs, bodies, templates);
    if (scattered) pairs.ordered_spread = pairs.spread;
}

void Simulation::State::compute_pair_forces(const detail::StepClock& clock) {
    pairs.pair_books.resize(recorder.started != 0 ? pairs.records.size() : 0);
    parallel_for(pairs.blocks.size(), 1, [&](std::size_t block) {
        detail::pair_contact_forces(pairs, block, kinematics, templates, balls, pellet_law, pellet_contact, *kernels, clock);
    });
}

void Simulation::State::compute_wall_forces(const detail::StepClock& clock) {
    for (detail::Wall& wall : walls) {
        wall.body_books.resize(recorder.started != 0 ? bodies.size() : 0);
        parallel_blocks(bodies.size(), wall_grain, [&](std::size_t begin, std::size_t end) {
            detail::wall_contact_forces(wall, begin / wall_grain, begin, end, kinematics, bodies, templates, wall_skins, clock);
        });
    }
}

void Simulation::State::gather_forces_and_kick(double kick) {
    std::vector<const detail::LoadRow*> wall_rows;
    std::vector<const std::uint8_t*> wall_flags;
    for (const detail::Wall& wall : walls) wall_rows.push_back(wall.loads.data()), wall_flags.push_back(wall.touching.data());
    if (!body_loads.empty()) wall_rows.push_back(body_loads.data()), wall_flags.push_back(body_loads_act.data());
    const Vec3& g = definition.gravity;
    const detail::GatherView loads{pairs.incoming_first.data(), pairs.incoming.data(), pairs.loads_j.data(), pairs.own_loads.data(), pairs.touching.data(),
                                   pairs.own_touching.data(),   wall_rows.size(),      wall_rows.data(),     wall_flags.data(),      {g.x(), g.y(), g.z()}};
    const detail::BodyArrays arrays = bodies.arrays(constants.data(), kinematics.data());
    parallel_blocks(bodies.size(), body_grain,
                    [&](std::size_t begin, std::size_t end) { kernels->gather(arrays, loads, begin, detail::padded_count(end), kick); });
}

void Simulation::State::sum_wall_loads() {
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const detail::Wall& wall = walls[w];
        const Vec3 point = wall.motion.point + wall.place.shift;  // the point on the axis moves with the translation
        wall_loads[w] = parallel_reduce(
            bodies.size(), 4 * sum_grain, WallLoad{},
            [&](std::size_t begin, std::size_t end) {
                WallLoad part;
                for (std::size_t id = begin; id < end; ++id) {
                    const std::size_t i = bodies.place_of(id);
                    if (!wall.touching[i]) continue;
                    const Vec3 force(wall.loads[i].force()[0], wall.loads[i].force()[1], wall.loads[i].force()[2]);
                    part.force -= force;
                    part.torque -=
                        Vec3(wall.loads[i].torque()[0], wall.loads[i].torque()[1], wall.loads[i].torque()[2]) + (bodies.position(i) - point).cross(force);
                }
                return part;
            },
            [](const WallLoad& a, const WallLoad& b) {
                return WallLoad{a.force + b.force, a.torque + b.torque, 0.0};
            });
        wall_loads[w].power = -(wall_loads[w].force.dot(wall.place.velocity) + wall_loads[w].torque.dot(wall.motion.axis) * wall.place.angular_speed);
    }
}

void Simulation::State::look_at_forces() {
    for (std::size_t i = 0; i < bodies.size(); ++i) detail::fill_record(bodies, templates[bodies.template_of(i)], i, kinematics[i]);
    const detail::StepClock clock{0.0, definition.time_step, static_cast<std::uint32_t>(steps)};
    compute_pair_forces(clock);
    compute_wall_forces(clock);
    compute_body_forces();
    gather_forces_and_kick(0.0);
    sum_wall_loads();
    view_is_current = false;
}

}  // namespace pelletlab::solver
