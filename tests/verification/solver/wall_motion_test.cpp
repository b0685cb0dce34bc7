// Walls that move and walls of different materials.
#include <gtest/gtest.h>

#include <cmath>

#include "scene.hpp"
#include "wall_meshes.hpp"

namespace pelletlab::solver {
namespace {

TEST(Wall, EachWallHasItsOwnMaterialAndContact) {
    // Two plates side by side. Normal force F = (4/3) E* sqrt(r) overlap^(3/2), 1/E* = (1-ν²)/E + (1-ν²)/E of the two; friction at most mu F.
    const double r = 1e-3, overlap = 2e-5;
    SimulationDefinition d;
    d.templates = {scene::sphere_template(r, 2000.0)};
    d.pellet_material = {1e7, 0.3};
    d.gravity = Vec3::Zero();
    const ElasticMaterial soft{2e6, 0.2}, stiff{8e10, 0.35};
    d.walls = {scene::wall("rubber", transformed(scene::plate(0.01), {{-0.01, 0, 0}, Quat::Identity()}), {0.9, 0.7, 0.0}, soft),
               scene::wall("steel", transformed(scene::plate(0.01), {{0.01, 0, 0}, Quat::Identity()}), {0.9, 0.2, 0.0}, stiff)};
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    b[0].pose.position = {-0.01, 0.0, r - overlap};
    b[1].pose.position = {0.01, 0.0, r - overlap};
    s.add_bodies(b);
    const auto expected = [&](const ElasticMaterial& m) {
        const auto compliance = [](const ElasticMaterial& e) {
            return (1.0 - e.poisson_ratio * e.poisson_ratio) / (2.0 * e.shear_modulus * (1.0 + e.poisson_ratio));
        };
        return 4.0 / 3.0 / (compliance(d.pellet_material) + compliance(m)) * std::sqrt(r) * std::pow(overlap, 1.5);
    };
    EXPECT_NEAR(s.bodies().force[0].z(), expected(soft), 1e-9 * expected(soft));
    EXPECT_NEAR(s.bodies().force[1].z(), expected(stiff), 1e-9 * expected(stiff));
    EXPECT_NEAR(s.wall_loads()[0].force.z(), -expected(soft), 1e-9 * expected(soft));
    EXPECT_NEAR(s.wall_loads()[1].force.z(), -expected(stiff), 1e-9 * expected(stiff));

    WallMotion slide;
    slide.velocity = {0.0, 50.0, 0.0};  // far faster than friction can follow
    for (const std::size_t wall : {0u, 1u}) s.set_wall_motion(wall, slide);
    s.step();
    for (const std::size_t i : {0u, 1u}) {
        const Vec3 load = s.wall_loads()[i].force;
        EXPECT_NEAR(load.y() / load.z(), d.walls[i].contact.sliding_friction, 1e-9) << i;
    }
}

TEST(Wall, FrictionFollowsTheSurfaceVelocityOfTheContactPoint) {
    // A plate that turns and slides: v = velocity + spin × (place - point). Full sliding, so the friction points along it exactly.
    const double r = 1e-3;
    SimulationDefinition d;
    d.templates = {scene::sphere_template(r, 2000.0)};
    d.gravity = Vec3::Zero();
    d.walls = {scene::wall("plate", scene::plate(0.05, 7), {0.5, 0.01, 0.0})};
    WallMotion motion;
    motion.point = {0.013, -0.007, 0.0};
    motion.axis = Vec3::UnitZ();
    motion.rotation_speed = -90.0;
    motion.velocity = {0.4, 0.3, 0.0};
    Simulation s(d);
    std::vector<BodyPlacement> b;
    for (int k = 0; k < 40; ++k) {
        RandomStream random(3, static_cast<std::uint64_t>(k));
        b.push_back({0, {{(k % 8 - 3.5) * 0.006, (k / 8 - 2.0) * 0.006, r - 2e-5}, random.rotation()}, Vec3::Zero(), Vec3::Zero()});
    }
    s.add_bodies(b);
    s.set_wall_motion(0, motion);
    s.step();
    for (std::size_t i = 0; i < b.size(); ++i) {
        const Vec3 contact(b[i].pose.position.x(), b[i].pose.position.y(), 0.0);
        const Vec3 surface = motion.velocity + Vec3(motion.axis * motion.rotation_speed).cross(contact - motion.point);
        const Vec3 friction(s.bodies().force[i].x(), s.bodies().force[i].y(), 0.0);
        // The wall turns by 1e-3 rad in the step.
        EXPECT_GT(friction.normalized().dot(surface.normalized()), 1.0 - 1e-6) << i;
        EXPECT_NEAR(friction.norm() / s.bodies().force[i].z(), 0.01, 1e-9) << i;
    }
}

TEST(Wall, AWallThatSlidesIsASphereThatSlidesTheOtherWay) {
    // Galilei: the same motion seen from two frames, on a hilly wall with friction.
    const TriangleMesh hills = scene::hills(0.05, 25, 1e-3, 9);
    const Vec3 speed(0.3, -0.1, 0.2);
    const auto path = [&](const Vec3& wall_speed) {
        SimulationDefinition d;
        d.templates = {scene::cylinder_template(2, 6)};
        d.walls = {scene::wall("hills", hills, {0.6, 0.4, 0.02})};
        d.domain = Box(Vec3::Constant(-1.0), Vec3::Constant(1.0));
        Simulation s(d);
        BodyPlacement b;
        b.pose = {{0.0, 0.0, 4e-3}, Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};
        b.velocity = Vec3(0.1, 0.1, -0.4) + wall_speed;
        b.spin = {40.0, -30.0, 20.0};
        s.add_bodies({&b, 1});
        WallMotion motion;
        motion.velocity = wall_speed;
        s.set_wall_motion(0, motion);
        std::vector<Vec3> seen;
        for (int k = 0; k < 30; ++k) {
            s.advance(50);
            seen.push_back(s.bodies().position[0] - wall_speed * s.time());
        }
        EXPECT_GT((s.bodies().velocity[0] - wall_speed - Vec3(0.1, 0.1, -0.4)).norm(), 0.1);  // it did bounce
        return seen;
    };
    const std::vector<Vec3> rest = path(Vec3::Zero()), moving = path(speed);
    for (std::size_t k = 0; k < rest.size(); ++k) EXPECT_LT((rest[k] - moving[k]).norm(), 1e-11) << k;
}

/// Drums of equal inner radius (of the facets' middles) with a bed of spheres, turning steadily.
class Drum : public testing::TestWithParam<int> {};

TEST_P(Drum, MeanTorqueAndForceAreThoseOfTheBedsWeight) {
    // Balance of momentum over a time T: mean force on the wall = weight - change of momentum / T; mean torque about the axis = moment of the weight about it
    // - change of angular momentum / T. Exact for every shape of drum, so a contact that pushes twice, at a wrong place or along a wrong line shows up.
    const int facets = GetParam();
    const double big_r = 0.03, r = 2e-3;
    SimulationDefinition d;
    d.templates = {scene::sphere_template(r, 2000.0)};
    d.pellet_contact = {0.4, 0.5, 0.05};
    WallDefinition shell = scene::wall("shell", scene::tube(big_r / std::cos(M_PI / facets), 0.02, facets), {0.4, 0.5, 0.05});
    shell.motion.rotation_speed = 2.0;
    d.walls = {shell};
    for (const double y : {-0.01, 0.01}) {
        const TriangleMesh end = transformed(scene::plate(0.04), {{0, y, 0}, Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitX()))});
        d.walls.push_back(scene::wall(y < 0 ? "front" : "back", end, {0.4, 0.0, 0.0}));
    }
    d.time_step = 2e-5;
    Simulation s(d);
    std::vector<BodyPlacement> b;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 8; ++i)
                b.push_back({0, {{(i - 3.5) * 4.4e-3 + 2e-4 * k, (j - 1.5) * 4.4e-3, -0.020 + 4.4e-3 * k}, Quat::Identity()}, Vec3::Zero(), Vec3::Zero()});
    std::erase_if(b, [&](const BodyPlacement& p) { return std::hypot(p.pose.position.x(), p.pose.position.z()) > big_r - 1.05 * r; });
    s.add_bodies(b);
    s.advance(5000);

    const MassProperties& m = d.templates[0].mass_properties;
    const auto momentum = [&](Vec3& linear, double& angular) {
        linear = Vec3::Zero(), angular = 0.0;
        const BodyState& now = s.bodies();
        for (std::size_t i = 0; i < now.size(); ++i) {
            linear += m.mass * now.velocity[i];
            angular += m.mass * now.position[i].cross(now.velocity[i]).y() + m.principal_inertia.x() * now.spin[i].y();
        }
    };
    Vec3 p0, p1, force = Vec3::Zero();
    double l0 = 0.0, l1 = 0.0, torque = 0.0, weight_moment = 0.0;
    momentum(p0, l0);
    const int steps = 15000;
    for (int k = 0; k < steps; ++k) {
        s.step();
        for (const WallLoad& load : s.wall_loads()) force += load.force / steps, torque += load.torque.y() / steps;
        for (const Vec3& p : s.bodies().position) weight_moment += p.cross(Vec3(0, 0, -9.81 * m.mass)).y() / steps;
    }
    momentum(p1, l1);
    const double weight = 9.81 * m.mass * static_cast<double>(b.size()), time = steps * d.time_step;
    const Vec3 expected_force = Vec3(0, 0, -weight) - (p1 - p0) / time;
    const double expected_torque = weight_moment - (l1 - l0) / time;
    // Velocity Verlet keeps the balances to rounding but for half a step at the ends.
    EXPECT_LT((force - expected_force).norm(), 1e-3 * weight) << facets;
    EXPECT_NEAR(torque, expected_torque, 1e-3 * weight * big_r) << facets;
    EXPECT_GT(std::abs(torque), 0.1 * weight * big_r);  // the bed is carried up
}

INSTANTIATE_TEST_SUITE_P(Wall, Drum, testing::Values(24, 120, 1200, 4800));

}  // namespace
}  // namespace pelletlab::solver
