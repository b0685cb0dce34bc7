#include "solver/time_step.hpp"

#include <gtest/gtest.h>

#include "../../verification/solver/scene.hpp"

namespace pelletlab::solver {
namespace {

TEST(TimeStep, RayleighStepIsThatOfTheFormula) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(0.765e-3, 1800.0)};
    d.pellet_material = {2e6, 0.25};
    // π · 0.765e-3 · sqrt(1800 / 2e6) / (0.1631 · 0.25 + 0.8766) = 7.8593e-5 s
    EXPECT_NEAR(advise_time_step(d).rayleigh, 7.8593e-5, 1e-9);
}

TEST(TimeStep, LimitOfASphereOnAWallIsThatOfItsSpring) {
    // A free elastic sphere pressed from both sides by walls: normal ω² = 2 S_n/m, tangential with rotation 2 S_t (1/m + r²/I); the larger one counts.
    SimulationDefinition d;
    const double r = 1e-3;
    d.templates = {scene::sphere_template(r, 2000.0)};
    d.pellet_material = {2e6, 0.25};
    d.walls = {scene::wall("w", scene::plate(1.0), {0.5, 0.5, 0.0}, {1e14, 0.25})};
    const double m = d.templates[0].mass_properties.mass, overlap = advise_time_step(d).assumed_overlap_ratio * r;
    const double e_star = 2e6 * 2.0 * 1.25 / (1.0 - 0.0625), g_star = 2e6 / 1.75;
    const double s_t = 8.0 * g_star * std::sqrt(r * overlap), s_n = 2.0 * e_star * std::sqrt(r * overlap);
    const double largest = 2.0 * std::max(s_n / m, s_t * (1.0 / m + 1.0 / (0.4 * m)));
    // A pair of such spheres is softer (half the modulus, half the radius) but twice as mobile: it decides unless the wall does.
    const double pair = 2.0 * largest / 2.0 / std::sqrt(2.0);
    EXPECT_NEAR(advise_time_step(d).contact_limit, 2.0 / std::sqrt(std::max(largest, pair)), 1e-3 * advise_time_step(d).contact_limit);
}

TEST(TimeStep, MoreSpheresOnAFaceShortenTheLimit) {
    SimulationDefinition d;
    d.templates = {scene::cylinder_template(3, 8)};
    const double few = advise_time_step(d).contact_limit;
    d.templates = {scene::cylinder_template(3, 32)};
    EXPECT_LT(advise_time_step(d).contact_limit, 0.6 * few);
}

}  // namespace
}  // namespace pelletlab::solver
