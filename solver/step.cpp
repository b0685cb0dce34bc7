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

constexpr std::size_t body_grain = 256;  ///< fixed, so sums do not depend on the number of threads

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
    const detail::StepClock clock{s.definition.time_step, s.definition.time_step};
    s.view_is_current = false;
    StopWatch watch(s.stage_seconds);
    s.kick_and_drift_bodies();
    watch.lap(0);
    s.move_walls();
    watch.lap(1);
    s.find_neighbours_if_needed();
    watch.lap(2);
    s.compute_pair_forces(clock);
    watch.lap(3);
    s.compute_wall_forces(clock);
    watch.lap(4);
    s.gather_forces();
    s.kick_bodies();
    s.sum_wall_loads();
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
    text << "body " << i;
    if (p.allFinite() && s.bodies.angular_momentum(i).allFinite()) {
        text << " left the domain at (" << p.x() << ", " << p.y() << ", " << p.z() << ") m with a speed of " << v.norm() << " m/s";
    } else {
        const Vec3 d = s.kinematics.size() > i ? Vec3(s.bodies.fx[i], s.bodies.fy[i], s.bodies.fz[i]) : Vec3::Zero();
        text << " has a position or a spin that is not a number (last force " << d.norm() << " N)";
    }
    text << ", time " << s.time() << " s, step " << s.steps;
    const double length = s.templates[s.bodies.template_index[i]].bounding_radius;
    const bool fast = !(v.norm() * s.definition.time_step < 0.05 * length);
    return numerical_failure(text.str(), fast
                                             ? "the speed says that contacts became unstable: use a smaller time step (advise_time_step), or check that bodies "
                                               "do not overlap at the start"
                                             : "the speed is a normal one: look for an opening in the walls, or give a larger domain");
}

}  // namespace

void Simulation::State::kick_and_drift_bodies() {
    const std::size_t n = bodies.size();
    const double dt = definition.time_step;
    const Vec3 low = domain.min(), high = domain.max();
    std::vector<std::size_t> lost((n + body_grain - 1) / body_grain, n);
    parallel_blocks(n, body_grain, [&](std::size_t begin, std::size_t end) {
        std::size_t first_lost = n;
        for (std::size_t i = end; i-- > begin;) {
            detail::kick_and_drift(bodies, templates[bodies.template_index[i]], i, dt, kinematics[i]);
            const bool inside = bodies.px[i] >= low.x() && bodies.px[i] <= high.x() && bodies.py[i] >= low.y() && bodies.py[i] <= high.y() &&
                                bodies.pz[i] >= low.z() && bodies.pz[i] <= high.z() && std::isfinite(bodies.lx[i] + bodies.ly[i] + bodies.lz[i]);
            if (!inside) first_lost = i;
        }
        lost[begin / body_grain] = first_lost;
    });
    ++steps;
    const auto first = std::min_element(lost.begin(), lost.end());
    if (first != lost.end() && *first < n) throw lost_body(*this, *first);
}

void Simulation::State::move_walls() {
    for (detail::Wall& wall : walls) detail::move_wall(wall, steps, definition.time_step);
}

void Simulation::State::find_neighbours_if_needed() {
    const std::size_t n = bodies.size();
    bool needed = pairs.reference.size() != n;
    if (!needed) {
        const double limit = 0.25 * pairs.skin * pairs.skin;
        const double furthest = parallel_reduce(
            n, 4 * body_grain, 0.0,
            [&](std::size_t begin, std::size_t end) {
                double most = 0.0;
                for (std::size_t i = begin; i < end; ++i) most = std::max(most, (bodies.position(i) - pairs.reference[i]).squaredNorm());
                return most;
            },
            [](double a, double b) { return std::max(a, b); });
        needed = furthest > limit;
    }
    if (needed) detail::rebuild_pairs(pairs, bodies, templates);
}

void Simulation::State::compute_pair_forces(const detail::StepClock& clock) {
    parallel_for(pairs.blocks.size(), 1,
                 [&](std::size_t block) { detail::pair_contact_forces(pairs, block, kinematics, bodies, templates, pellet_law, *kernels, clock); });
}

void Simulation::State::compute_wall_forces(const detail::StepClock& clock) {
    for (detail::Wall& wall : walls)
        parallel_blocks(bodies.size(), body_grain, [&](std::size_t begin, std::size_t end) {
            detail::wall_contact_forces(wall, begin, end, kinematics, bodies, templates, wall_skins, *kernels, clock);
        });
}

/// Gravity, then pairs in which the body comes second, then those in which it comes first, then walls: always in this order.
void Simulation::State::gather_forces() {
    parallel_blocks(bodies.size(), body_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double mass = templates[bodies.template_index[i]].mass;
            double f[3] = {definition.gravity.x() * mass, definition.gravity.y() * mass, definition.gravity.z() * mass};
            double t[3] = {0.0, 0.0, 0.0};
            for (std::uint32_t k = pairs.incoming_first[i]; k < pairs.incoming_first[i + 1]; ++k) {
                const std::uint32_t pair = pairs.incoming[k];
                if (!pairs.touching[pair]) continue;
                for (int c = 0; c < 3; ++c) f[c] += pairs.loads[pair].force[c], t[c] += pairs.loads[pair].torque_j[c];
            }
            for (std::uint32_t pair = pairs.rows.first[i]; pair < pairs.rows.first[i + 1]; ++pair) {
                if (!pairs.touching[pair]) continue;
                for (int c = 0; c < 3; ++c) f[c] -= pairs.loads[pair].force[c], t[c] += pairs.loads[pair].torque_i[c];
            }
            for (const detail::Wall& wall : walls) {
                if (!wall.touching[i]) continue;
                for (int c = 0; c < 3; ++c) f[c] += wall.loads[i].force[c], t[c] += wall.loads[i].torque[c];
            }
            bodies.fx[i] = f[0], bodies.fy[i] = f[1], bodies.fz[i] = f[2];
            bodies.tx[i] = t[0], bodies.ty[i] = t[1], bodies.tz[i] = t[2];
        }
    });
}

void Simulation::State::kick_bodies() {
    const double half = 0.5 * definition.time_step;
    parallel_blocks(bodies.size(), body_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double a = templates[bodies.template_index[i]].inverse_mass;
            bodies.vx[i] += bodies.fx[i] * a * half, bodies.vy[i] += bodies.fy[i] * a * half, bodies.vz[i] += bodies.fz[i] * a * half;
            bodies.lx[i] += bodies.tx[i] * half, bodies.ly[i] += bodies.ty[i] * half, bodies.lz[i] += bodies.tz[i] * half;
        }
    });
}

void Simulation::State::sum_wall_loads() {
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const detail::Wall& wall = walls[w];
        const WallLoad sum = parallel_reduce(
            bodies.size(), 4 * body_grain, WallLoad{},
            [&](std::size_t begin, std::size_t end) {
                WallLoad part;
                for (std::size_t i = begin; i < end; ++i) {
                    if (!wall.touching[i]) continue;
                    part.force -= Vec3(wall.loads[i].force[0], wall.loads[i].force[1], wall.loads[i].force[2]);
                    part.torque += Vec3(wall.loads[i].on_wall[0], wall.loads[i].on_wall[1], wall.loads[i].on_wall[2]);
                }
                return part;
            },
            [](const WallLoad& a, const WallLoad& b) {
                return WallLoad{a.force + b.force, a.torque + b.torque};
            });
        // From the origin of the wall's frame to the point on the axis, which moves with the translation.
        const double since = static_cast<double>(steps - wall.motion_start) * definition.time_step;
        const Vec3 point = wall.motion.point + wall.motion.velocity * since;
        wall_loads[w] = {sum.force, sum.torque + (wall.pose.position - point).cross(sum.force)};
    }
}

void Simulation::State::look_at_forces() {
    for (std::size_t i = 0; i < bodies.size(); ++i) detail::fill_record(bodies, templates[bodies.template_index[i]], i, kinematics[i]);
    find_neighbours_if_needed();
    const detail::StepClock clock{0.0, definition.time_step};
    compute_pair_forces(clock);
    compute_wall_forces(clock);
    gather_forces();
    sum_wall_loads();
    view_is_current = false;
}

}  // namespace pelletlab::solver
