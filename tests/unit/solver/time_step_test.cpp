#include "solver/time_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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
    // A free elastic sphere pressed from both sides by walls: normal ω² = 2 S_n/m, sliding 2 S_t/m, turning between them 2 S_t r²/I; the largest counts.
    SimulationDefinition d;
    const double r = 1e-3;
    d.templates = {scene::sphere_template(r, 2000.0)};
    d.pellet_material = {2e6, 0.25};
    d.walls = {scene::wall("w", scene::plate(1.0), {0.5, 0.5, 0.0}, {1e14, 0.25})};
    const double m = d.templates[0].mass_properties.mass, overlap = advise_time_step(d).assumed_overlap_ratio * r;
    const double e_star = 2e6 * 2.0 * 1.25 / (1.0 - 0.0625), g_star = 2e6 / 1.75;
    const double s_t = 8.0 * g_star * std::sqrt(r * overlap), s_n = 2.0 * e_star * std::sqrt(r * overlap);
    const double largest = 2.0 * std::max(s_n / m, s_t / (0.4 * m));
    // A pair of such spheres is softer (half the modulus, half the radius) but twice as mobile: it decides unless the wall does.
    const double pair = 2.0 * largest / 2.0 / std::sqrt(2.0);
    EXPECT_NEAR(advise_time_step(d).contact_limit, 2.0 / std::sqrt(std::max(largest, pair)), 1e-3 * advise_time_step(d).contact_limit);
}

TEST(TimeStep, LimitFallsWithTheFourthRootOfTheOverlap) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(1e-3, 2000.0)};
    const TimeStepAdvice advice = advise_time_step(d);
    EXPECT_NEAR(advice.limit_at(16.0 * advice.assumed_overlap_ratio), 0.5 * advice.contact_limit, 1e-12 * advice.contact_limit);
    d.physics.contact = ContactModel::linear;
    const TimeStepAdvice linear = advise_time_step(d);
    EXPECT_DOUBLE_EQ(linear.limit_at(1.0), linear.contact_limit);
}

TEST(TimeStep, DampedLimitOfALinearDashpotIsThatOfTheFormula) {
    // One normal mode of a sphere between two walls: ω² = 2 k/m, 2 ζ ω = 2 c/m, h² + 8 ζ h = 4. Friction is off, but its springs count: so compare with
    // the turning mode, which is the stiffest: ω² = 2 k_t r²/I and 2 ζ ω = 2 c_t r²/I.
    SimulationDefinition d;
    const double r = 1e-3, k = 1e4, e = 0.4;
    d.templates = {scene::sphere_template(r, 2000.0)};
    d.pellet_material = {2e6, 0.25};
    d.physics.contact = ContactModel::linear;
    d.physics.linear_stiffness = k;
    const TimeStepAdvice advice = advise_time_step(d);
    const double m = d.templates[0].mass_properties.mass, ratio = 2.0 * (1.0 - 0.25) / (2.0 - 0.25);
    const double beta = -std::log(e) / std::hypot(std::log(e), M_PI), c = 2.0 * beta * std::sqrt(0.5 * m * k) * std::sqrt(ratio);
    const double stiffness = 2.0 * 2.0 * ratio * k / (0.4 * m), damping = 2.0 * 2.0 * c / (0.4 * m);  // twice mobile, two sides
    EXPECT_NEAR(advice.contact_limit, 2.0 / std::sqrt(stiffness), 1e-3 * advice.contact_limit);
    EXPECT_NEAR(advice.damped_limit, 2.0 / (std::sqrt(damping * damping + stiffness) + damping), 1e-3 * advice.damped_limit);
}

TEST(TimeStep, MoreSpheresOnAFaceShortenTheLimit) {
    SimulationDefinition d;
    d.templates = {scene::cylinder_template(3, 8)};
    const double few = advise_time_step(d).contact_limit;
    d.templates = {scene::cylinder_template(3, 32)};
    EXPECT_LT(advise_time_step(d).contact_limit, 0.7 * few);
}

SimulationDefinition sticky(Cohesion cohesion) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(1e-3, 2000.0)};
    d.pellet_material = {2e6, 0.25};
    d.physics.cohesion = cohesion;
    d.physics.liquid.surface_tension = 50.0;  // far more than any liquid has: to see its effect
    return d;
}

TEST(TimeStep, CohesionPressesContactsTogetherAndShortensTheLimit) {
    // Forces that act while spheres touch leave them where push = pull; the limit is that of Hertz at 0.1 r beyond.
    const double r = 1e-3, reduced = 0.5 * r, modulus = 2e6 * 1.25 / (1.0 - 0.0625);  // E* of equal materials
    const double without = advise_time_step(sticky(Cohesion::none)).contact_limit;
    const auto expect_rest = [&](const SimulationDefinition& d, double overlap, const char* what) {
        const TimeStepAdvice advice = advise_time_step(d);
        EXPECT_NEAR(advice.assumed_overlap_ratio, 0.1 + overlap / r, 1e-9) << what;
        EXPECT_NEAR(advice.contact_limit, without * std::pow(0.1 / (0.1 + overlap / r), 0.25), 1e-6 * without) << what;
        EXPECT_LT(advice.contact_limit, 0.9 * without) << what;
    };
    const double hertz = 4.0 / 3.0 * modulus * std::sqrt(reduced);
    SimulationDefinition d = sticky(Cohesion::constant_force);
    d.pellet_contact.attraction_force = 0.5;
    expect_rest(d, std::pow(0.5 / hertz, 2.0 / 3.0), "constant force");
    d = sticky(Cohesion::sjkr);
    d.pellet_contact.cohesion_energy_density = 3e5;
    expect_rest(d, std::pow(2.0 * M_PI * 3e5 * reduced / hertz, 2.0), "sjkr");
    d = sticky(Cohesion::capillary);
    expect_rest(d, std::pow(4.0 * M_PI * 50.0 * reduced / hertz, 2.0 / 3.0), "capillary");
}

TEST(TimeStep, JkrCountsWithItsOwnStiffness) {
    // Against finite differences of the force: F(δ) by its two parametric formulas. Friction is what turns spheres; without it the normal mode decides, so
    // give it a body that hardly turns.
    SimulationDefinition d = sticky(Cohesion::jkr);
    d.pellet_contact.work_of_adhesion = 40.0;
    d.templates[0].mass_properties.principal_inertia *= 100.0;
    const double r = 1e-3, reduced = 0.5 * r, modulus = 2e6 * 1.25 / (1.0 - 0.0625), w = 40.0, m = d.templates[0].mass_properties.mass;
    const TimeStepAdvice advice = advise_time_step(d);
    const auto overlap_of = [&](double a) { return a * a / reduced - std::sqrt(2.0 * M_PI * w * a / modulus); };
    const auto force_of = [&](double a) { return 4.0 * modulus * a * a * a / (3.0 * reduced) - std::sqrt(8.0 * M_PI * w * modulus * a * a * a); };
    const auto neck_of = [&](const std::function<double(double)>& f, double value) {  // f rises from its last minimum on
        double low = std::cbrt(9.0 * M_PI * w * reduced * reduced / (8.0 * modulus)), high = r;
        for (int k = 0; k < 200; ++k) (f(0.5 * (low + high)) < value ? low : high) = 0.5 * (low + high);
        return low;
    };
    const double rest = overlap_of(neck_of(force_of, 0.0));
    EXPECT_NEAR(advice.assumed_overlap_ratio, 0.1 + rest / r, 1e-6);
    const double a = neck_of(overlap_of, 0.1 * r + rest), h = 1e-4 * a;
    const double stiffness = (force_of(a + h) - force_of(a - h)) / (overlap_of(a + h) - overlap_of(a - h));
    const double hertz = 2.0 * modulus * std::sqrt(reduced * (0.1 * r + rest)), tangential = hertz * 2.0 * (1.0 - 0.25) / (2.0 - 0.25);
    const double turning = tangential * r * r / (40.0 * m * r * r);  // against 0.4 m r² × 100
    ASSERT_GT(stiffness / m, tangential / m + turning);
    EXPECT_GT(std::abs(stiffness / hertz - 1.0), 0.01);  // so the test can tell them apart
    EXPECT_NEAR(advice.contact_limit, 2.0 / std::sqrt(2.0 * 2.0 * stiffness / m), 1e-4 * advice.contact_limit);
}

}  // namespace
}  // namespace pelletlab::solver
