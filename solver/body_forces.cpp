#include "solver/body_forces.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "solver/detail/state.hpp"

namespace pelletlab::solver {

namespace {

Vec3 drag(const StillAir& air, double diameter, const Vec3& v) {
    const double reynolds = air.density * v.norm() * diameter / air.viscosity;
    if (reynolds > 1000.0) return v * (-0.44 * M_PI / 8.0 * air.density * diameter * diameter * v.norm());
    return v * (-3.0 * M_PI * air.viscosity * diameter * (1.0 + 0.15 * std::pow(reynolds, 0.687)));
}

}  // namespace

void Simulation::State::compute_body_forces() {
    const BodyForces& forces = definition.body_forces;
    if (!forces.any()) return;
    const std::size_t n = bodies.size();
    body_loads.resize(n);
    body_loads_act.assign(n, 1);
    body_force_power = parallel_reduce(
        n, detail::sum_grain, 0.0,
        [&](std::size_t begin, std::size_t end) {
            double power = 0.0;
            for (std::size_t i = begin; i < end; ++i) {
                const detail::BodyTemplate& t = templates[bodies.template_of(i)];
                const double *v = kinematics[i].velocity(), *w = kinematics[i].spin();
                const Vec3 velocity(v[0], v[1], v[2]), spin(w[0], w[1], w[2]);
                Vec3 force = forces.attraction * t.mass, torque = Vec3::Zero();
                if (forces.air.density > 0.0) {
                    const double d = t.equivalent_diameter;
                    force += drag(forces.air, d, velocity);
                    torque -= spin * (M_PI * forces.air.viscosity * d * d * d);
                }
                detail::LoadRow& load = body_loads[i];
                load = detail::LoadRow{};
                for (int k = 0; k < 3; ++k) load.force()[k] = force[k], load.torque()[k] = torque[k];
                power += force.dot(velocity) + torque.dot(spin);
            }
            return power;
        },
        [](double a, double b) { return a + b; });
}

namespace detail {

void check_body_forces(const BodyForces& f) {
    const bool good =
        f.air.density >= 0.0 && std::isfinite(f.air.density) && f.air.viscosity > 0.0 && std::isfinite(f.air.viscosity) && f.attraction.allFinite();
    if (!good) throw bad_input("body forces: air needs a density of zero or more, a positive viscosity, and the attraction finite numbers", "correct them");
}

}  // namespace detail

}  // namespace pelletlab::solver
