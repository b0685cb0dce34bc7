// Contacts of two bodies: closed forms, conservation, equivalences.
#include <gtest/gtest.h>

#include "scene.hpp"

namespace pelletlab::solver {
namespace {

struct Momentum {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momentum momentum_of(const Simulation& s) {
    Momentum sum;
    const BodyState& b = s.bodies();
    for (std::size_t i = 0; i < b.size(); ++i) {
        const MassProperties& m = s.definition().templates[b.template_index[i]].mass_properties;
        const Mat3 r = b.orientation[i].toRotationMatrix();
        sum.linear += m.mass * b.velocity[i];
        sum.angular += m.mass * b.position[i].cross(b.velocity[i]) + r * m.principal_inertia.cwiseProduct(r.transpose() * b.spin[i]);
    }
    return sum;
}

TEST(Contact, CollisionOfTwoClumpsKeepsLinearAndAngularMomentum) {
    SimulationDefinition d;
    d.templates = {scene::cylinder_template(4, 12)};
    d.gravity = Vec3::Zero();
    d.pellet_contact = {0.4, 0.7, 0.05};
    d.time_step = 2e-6;
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    RandomStream random(3, 0);
    b[0].pose.orientation = random.rotation();
    b[1].pose = {{3.9e-3, 0.9e-3, 0.4e-3}, random.rotation()};
    b[0].velocity = {0.4, 0.0, 0.1};
    b[1].velocity = {-0.4, -0.1, 0.0};
    b[0].spin = {30.0, -20.0, 50.0};
    s.add_bodies(b);
    const Momentum before = momentum_of(s);
    const Vec3 v_before = s.bodies().velocity[0];
    bool touched = false;
    for (int k = 0; k < 200; ++k) {
        s.advance(20);
        touched = touched || s.contacts().touching_pairs > 0;
    }
    const Momentum after = momentum_of(s);
    EXPECT_TRUE(touched);
    EXPECT_GT((s.bodies().velocity[0] - v_before).norm(), 0.1);
    const double scale = d.templates[0].mass_properties.mass * 0.4;
    EXPECT_LT((after.linear - before.linear).norm(), 1e-13 * scale);
    // The position changes between force and kick are second order, so angular momentum is kept to rounding as well: forces act along one line.
    EXPECT_LT((after.angular - before.angular).norm(), 1e-12 * scale * 4e-3);
}

/// Chung & Ooi 2011, test 1: two equal elastic spheres.
TEST(Contact, ElasticSpheresFollowHertz) {
    const double e_modulus = 4.8e10, nu = 0.2, r = 0.01, v = 20.0;
    SimulationDefinition d;
    d.templates = {scene::sphere_template(r, 2800.0)};
    d.pellet_material = {e_modulus / (2.0 * (1.0 + nu)), nu};
    d.pellet_contact = {1.0, 0.35, 0.0};
    d.gravity = Vec3::Zero();
    d.time_step = 1e-8;
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    b[0].pose.position = {-r - 1e-7, 0, 0};
    b[1].pose.position = {r + 1e-7, 0, 0};
    b[0].velocity = {0.5 * v, 0, 0};
    b[1].velocity = {-0.5 * v, 0, 0};
    s.add_bodies(b);
    double deepest = 0.0, strongest = 0.0, begin = 0.0, end = 0.0, last_overlap = 0.0;
    for (int k = 0; k < 6000; ++k) {
        s.step();
        const double overlap = 2.0 * r - (s.bodies().position[1] - s.bodies().position[0]).norm();
        if (overlap > 0.0 && last_overlap <= 0.0) begin = s.time() - d.time_step * overlap / (overlap - last_overlap);
        if (overlap <= 0.0 && last_overlap > 0.0) end = s.time() - d.time_step * overlap / (overlap - last_overlap);
        last_overlap = overlap;
        deepest = std::max(deepest, overlap);
        strongest = std::max(strongest, s.bodies().force[1].x());
    }
    EXPECT_NEAR(deepest, 274.113e-6, 1e-4 * 274.113e-6);
    EXPECT_NEAR(strongest, 10696.9, 1e-4 * 10696.9);
    EXPECT_NEAR(end - begin, 40.3395e-6, 1e-3 * 40.3395e-6);
    EXPECT_NEAR(s.bodies().velocity[1].x(), 0.5 * v, 1e-4 * v);
}

TEST(Contact, TangentialForceGrowsWithTotalDisplacementAndStopsAtCoulomb) {
    // A sphere pressed on a plate that starts to slide slowly: first S_t s, then μ F_n. The plate's load is the sphere's with the other sign.
    SimulationDefinition d;
    const double r = 5e-3, mu = 0.3;
    d.templates = {scene::sphere_template(r, 2500.0)};
    d.pellet_material = {1e7, 0.25};
    d.walls = {scene::wall("floor", scene::plate(0.1), {0.02, mu, 0.0}, {1e7, 0.25})};
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {0, 0, r};
    s.add_bodies({&b, 1});
    s.advance(20000);
    const double weight = d.templates[0].mass_properties.mass * 9.81;
    EXPECT_NEAR(s.wall_loads()[0].force.z(), -weight, 1e-6 * weight);
    WallMotion motion;
    motion.velocity = {1.0, 0.0, 0.0};  // far faster than the sphere can follow
    s.set_wall_motion(0, motion);
    s.advance(100);
    EXPECT_NEAR(s.wall_loads()[0].force.x(), -mu * -s.wall_loads()[0].force.z(), 1e-9 * weight);
}

TEST(Contact, ClumpOfOneSphereEqualsCoincidentMassDistribution) {
    // One sphere as a clump with its centre moved inside the template by zero: the same bits whatever the template around it holds.
    const auto run = [](bool with_second_template) {
        SimulationDefinition d = scene::falling_definition(scene::sphere_template(1e-3, 2000.0));
        if (with_second_template) d.templates.push_back(scene::dumbbell_template(1e-3, 1e-3, 2000.0));
        Simulation s(d);
        s.add_bodies(scene::lattice(5, 5, 4, 2.5e-3, 1));
        s.advance(2000);
        return s.bodies().position;
    };
    const auto a = run(false), b = run(true);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i], b[i]);
}

TEST(Contact, TouchingPairThatTurnsAsAWholeKeepsItsSpring) {
    // Two spheres pressed together by their approach would bounce; instead, check objectivity of the history: the same collision seen in
    // a rotated frame gives rotated results.
    const auto run = [](const Quat& frame) {
        SimulationDefinition d;
        d.templates = {scene::cylinder_template(2, 6)};
        d.gravity = Vec3::Zero();
        d.time_step = 2e-6;
        Simulation s(d);
        std::vector<BodyPlacement> b(2);
        b[0].pose = {frame * Vec3(0, 0, 0), frame};
        b[1].pose = {frame * Vec3(3.4e-3, 0.5e-3, 0.3e-3), frame * Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()))};
        b[0].velocity = frame * Vec3(0.3, 0, 0);
        b[1].velocity = frame * Vec3(-0.3, 0.1, 0);
        b[0].spin = frame * Vec3(10, 20, -30);
        s.add_bodies(b);
        s.advance(3000);
        return frame.conjugate() * s.bodies().velocity[1];
    };
    const Vec3 a = run(Quat::Identity()), b = run(Quat(Eigen::AngleAxisd(1.1, Vec3(-1, 0.5, 2).normalized())));
    EXPECT_GT((a - Vec3(-0.3, 0.1, 0)).norm(), 0.1);
    EXPECT_LT((a - b).norm(), 1e-9);  // rounding, grown by some hundred contact steps
}

}  // namespace
}  // namespace pelletlab::solver
