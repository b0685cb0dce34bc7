// C2: contacts dissipate as viscoelastic spheres do (Brilliantov, Spahn, Hertzsch & Pöschel 1996), so the restitution falls with speed; at v₀ = 0.3 m/s it is
// the case's own. On or off.
//
// m ξ'' = −ρ ξ^(3/2) − (3/2) A ρ √ξ ξ', no pull, ρ = (4/3) E* √R*. With length L = (m v₀²/ρ)^(2/5) and time T = L/v₀ this is x'' = −x^(3/2) − α √x x', x'(0) =
// 1, α = (3/2) A / T: one curve e(α) for all spheres. The relaxation time is A = (2/3) α T with e(α) = e. m, R*: a ball of 3.5 mm, which a pellet of the study
// weighs as much as.
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

namespace {

/// Restitution of the impact with the dimensionless damping α: velocity Verlet would not know the damping force, so the classical Runge–Kutta scheme; 2000
/// steps over the contact, error below 1e-6.
double restitution_of(double alpha) {
    constexpr double dt = 2e-3;
    const auto push = [alpha](double x, double v) {
        if (x <= 0.0) return 0.0;
        return std::max(0.0, std::sqrt(x) * (x + alpha * v));
    };
    double x = 0.0, v = -1.0;  // x: penetration, v: speed of separation, so x' = −v and the push is along v
    for (int n = 0; n < 100000; ++n) {
        const auto slope = [&](double at, double speed) { return std::pair(-speed, push(at, -speed)); };
        const auto [x1, v1] = slope(x, v);
        const auto [x2, v2] = slope(x + 0.5 * dt * x1, v + 0.5 * dt * v1);
        const auto [x3, v3] = slope(x + 0.5 * dt * x2, v + 0.5 * dt * v2);
        const auto [x4, v4] = slope(x + dt * x3, v + dt * v3);
        x += dt / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4);
        v += dt / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
        if (v > 0.0 && x <= 0.0) return v;
        if (v > 0.0 && push(x, -v) == 0.0) return v;  // nothing pulls it back any more
    }
    return 0.0;
}

double damping_for(double restitution) {
    double low = 0.0, high = 1.0;
    while (restitution_of(high) > restitution) high *= 2.0;
    for (int n = 0; n < 50; ++n) {
        const double middle = 0.5 * (low + high);
        (restitution_of(middle) > restitution ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double plane_compliance(const Material& m) {
    return (1.0 - m.poisson_ratio) / (2.0 * m.shear_modulus);  // (1 − ν²)/E
}

}  // namespace

Effect velocity_dependent_restitution() {
    return {"C2",
            "velocity_dependent_restitution",
            "restitution falls with speed",
            "viscoelastic contacts with the case's restitution at 0.3 m/s, more below, less above; on or off",
            "Brilliantov et al. 1996",
            "contact",
            "1",
            1.0,
            false,
            {1.0},
            {},
            "drop a pellet from three heights",
            [](Case& c, double) {
                if (c.physics.contact_model == "viscoelastic")
                    throw bad_input("the case has viscoelastic contacts already", "take the effect out, or give the case another contact law");
                constexpr double diameter = 3.5e-3, speed = 0.3;
                const Material& pellet = c.materials.at(c.pellet.material);
                const double ball = pellet.density * std::numbers::pi / 6.0 * diameter * diameter * diameter;
                for (auto& [name, row] : c.contacts) {
                    const bool with_pellet = name == "pellet-pellet";
                    const auto other = c.materials.find(name.substr(std::string("pellet-").size()));
                    const Material& partner = with_pellet || other == c.materials.end() ? pellet : other->second;
                    const double mass = with_pellet ? 0.5 * ball : ball, radius = 0.5 * diameter * (with_pellet ? 0.5 : 1.0);
                    const double rho = 4.0 / 3.0 / (plane_compliance(pellet) + plane_compliance(partner)) * std::sqrt(radius);
                    const double time = std::pow(mass / rho, 0.4) * std::pow(speed, -0.2);
                    row.relaxation_time = 2.0 / 3.0 * damping_for(row.restitution) * time;
                }
                c.physics.contact_model = "viscoelastic";
            },
            {}};
}

}  // namespace pelletlab::experiments::effects
