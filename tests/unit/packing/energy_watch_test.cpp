// The watch that ends a run whose energy comes from nowhere.
#include "packing/energy_watch.hpp"

#include <gmock/gmock.h>

#include "../../verification/solver/scene.hpp"
#include "core/error.hpp"
#include "packing/fill_tube.hpp"
#include "tests/unit/packing/small_case.hpp"

using namespace pelletlab;
using packing::EnergyWatch;
using testing::HasSubstr;

namespace {

/// Nine spheres over a floor, all with this upward speed.
solver::Simulation spheres(double speed, double floor_speed = 0.0) {
    solver::SimulationDefinition d;
    d.templates = {solver::scene::sphere_template(1e-3, 2000.0)};
    d.walls = {solver::scene::wall("floor", solver::scene::plate(0.02), {0.5, 0.5, 0.05})};
    d.domain = Box(Vec3::Constant(-1.0), Vec3::Constant(1.0));
    solver::Simulation s(d);
    std::vector<solver::BodyPlacement> bodies;
    for (int k = 0; k < 9; ++k) {
        solver::BodyPlacement b;
        b.pose.position = {(k % 3 - 1) * 3e-3, (k / 3 - 1) * 3e-3, 1.2e-3};
        b.velocity = {0.0, 0.0, speed};
        bodies.push_back(b);
    }
    s.add_bodies(bodies);
    if (floor_speed > 0.0) {
        solver::WallMotion up;
        up.velocity = {0.0, 0.0, floor_speed};
        s.set_wall_motion(0, up);
    }
    return s;
}

double weight_times_diameter() {
    return 9.0 * solver::scene::sphere_template(1e-3, 2000.0).mass_properties.mass * 9.81 * 2e-3;
}

std::string numerical_error(EnergyWatch& watch, const solver::Simulation& s, double overlap) {
    try {
        watch.look(s, overlap);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::numerical);
        EXPECT_THAT(error.remedy(), HasSubstr("smaller time.step"));
        return error.problem();
    }
    return "";
}

}  // namespace

TEST(EnergyWatch, LetsABedFallBounceAndRest) {
    solver::Simulation s = spheres(0.0);
    EnergyWatch watch(s);
    for (int k = 0; k < 100; ++k) {
        s.advance(100);
        EXPECT_NO_THROW(watch.look(s, s.contacts().largest_overlap_ratio));
    }
}

TEST(EnergyWatch, CountsWhatAWallPutsIn) {
    // The floor comes up at 1 m/s and throws spheres that were at rest: their energy has risen far above the allowance, and all of it is the floor's work.
    solver::Simulation s = spheres(0.0, 1.0);
    EnergyWatch watch(s);
    for (int k = 0; k < 20; ++k) {
        s.advance(10);
        EXPECT_NO_THROW(watch.look(s, s.contacts().largest_overlap_ratio));
    }
    EXPECT_GT(s.energy().kinetic_translation, 5.0 * weight_times_diameter());
}

TEST(EnergyWatch, EndsARunThatGainsEnergyAndSaysWhenWhyAndHowMuch) {
    const solver::Simulation still = spheres(0.0);
    EnergyWatch watch(still);
    const double mass = 9.0 * still.definition().templates[0].mass_properties.mass;
    // ½ m v² just below and just above the allowance, which is the largest kinetic energy so far (none) and m g d of all.
    const double speed = std::sqrt(2.0 * weight_times_diameter() / mass);
    EXPECT_EQ(numerical_error(watch, spheres(0.99 * speed), 0.2), "");
    const std::string problem = numerical_error(watch, spheres(1.01 * speed), 0.2);
    for (const char* part : {"gained", "J that nothing put in", "unstable", "time 0 s, step 0", "0.2 of a sphere's radius", "% of the limit"})
        EXPECT_THAT(problem, HasSubstr(part));
}

TEST(EnergyWatch, ASlowExplosionDoesNotRaiseItsOwnAllowance) {
    EnergyWatch watch(spheres(0.2));
    double speed = 0.2;
    std::string problem;
    while (problem.empty() && speed < 10.0) problem = numerical_error(watch, spheres(speed *= 1.02), 0.1);
    EXPECT_THAT(problem, HasSubstr("gained"));
    // Allowed is as much again as it had at first, and m g d: ½ v² = 2 · ½ v₀² + g d. The last step may go 2 % beyond.
    EXPECT_LT(speed, 1.02 * std::sqrt(2.0 * 0.2 * 0.2 + 2.0 * 9.81 * 2e-3));
}

TEST(EnergyWatch, EndsARunWhoseSpheresHavePassedThroughEachOther) {
    const solver::Simulation s = spheres(0.0);
    EnergyWatch watch(s);
    EXPECT_EQ(numerical_error(watch, s, 0.99), "");
    EXPECT_THAT(numerical_error(watch, s, 1.0), HasSubstr("passed through each other"));
}

TEST(EnergyWatch, WatchesRuns) {
    // Shot down at 60 m/s with a step that suits a gentle fall: overlaps far beyond those that the step was judged for.
    Case c = small_case::tube_case(20);
    c.insertion.fall_speed = 60.0;
    std::size_t frames = 0;
    try {
        packing::fill_tube(c, small_case::dumbbell_inputs(), [&](const TrajectoryHeader&) { return [&](const Frame&) { ++frames; }; }, {});
        FAIL() << "the run should have ended";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::numerical) << error.what();
        EXPECT_THAT(error.problem(), HasSubstr("time ")) << error.what();
        EXPECT_THAT(error.problem(), HasSubstr("step ")) << error.what();
    }
    EXPECT_GT(frames, 0u);
}
