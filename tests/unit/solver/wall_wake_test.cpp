// Bodies far from a wall are left alone until they or the wall have gone far: a wall that comes along must find them at the very step at which it touches.
#include <gtest/gtest.h>

#include <cmath>

#include "../../verification/solver/scene.hpp"

namespace pelletlab::solver {
namespace {

constexpr double radius = 1e-3;

/// A plate in the plane z = 0 moves; a ball floats at `place`. The wall's force must begin at the step at which the plane comes closer than the radius.
void expect_contact_in_time(const WallMotion& motion, const Vec3& place, std::uint64_t most_steps) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(radius, 2000.0)};
    d.walls = {scene::wall("plate", scene::plate(0.06), {0.4, 0.5, 0.05})};
    d.walls[0].motion = motion;
    d.gravity = Vec3::Zero();
    d.domain = Box(Vec3::Constant(-0.2), Vec3::Constant(0.2));
    Simulation s(d);
    std::vector<BodyPlacement> ball(1);
    ball[0].pose.position = place;
    s.add_bodies(ball);
    for (std::uint64_t step = 1; step <= most_steps; ++step) {
        s.step();
        const WallPlace at = place_at(motion, static_cast<double>(step) * d.time_step);
        const Vec3 normal = Eigen::AngleAxisd(at.angle, motion.axis) * Vec3::UnitZ();
        const double overlap = radius - normal.dot(place - (motion.point + at.shift));
        if (std::abs(overlap) < 1e-12) continue;  // rounding decides
        const bool pushes = s.wall_loads()[0].force.norm() > 0.0;
        ASSERT_EQ(pushes, overlap > 0.0) << "step " << step << ", overlap " << overlap;
        if (pushes) return;
    }
    FAIL() << "the wall never came";
}

TEST(WallWake, APlateThatRisesFindsTheBall) {
    WallMotion motion;
    motion.velocity = {0.0, 0.0, 0.9};
    expect_contact_in_time(motion, {0.01, -0.02, 0.03}, 4000);
}

TEST(WallWake, APlateThatTurnsFindsABallFarFromItsAxis) {
    WallMotion motion;
    motion.rotation_speed = 20.0;  // about y: what lies at x < 0 rises
    expect_contact_in_time(motion, {-0.045, 0.0, 0.02}, 4000);
}

TEST(WallWake, AnOscillatingPlateFindsTheBall) {
    WallMotion motion;
    motion.oscillation = {0.0, 0.0, -0.02};  // away first
    motion.frequency = 12.0;
    expect_contact_in_time(motion, {0.0, 0.0, 0.019}, 9000);
}

}  // namespace
}  // namespace pelletlab::solver
