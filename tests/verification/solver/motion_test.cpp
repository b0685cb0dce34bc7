// Motion of single bodies against closed forms.
#include <gtest/gtest.h>

#include "scene.hpp"

namespace pelletlab::solver {
namespace {

TEST(Motion, FreeFallFollowsTheParabola) {
    SimulationDefinition d;
    d.templates = {scene::cylinder_template(3, 8)};
    d.domain = Box(Vec3::Constant(-10.0), Vec3::Constant(10.0));
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {0.1, 0.2, 3.0};
    b.velocity = {0.3, -0.2, 0.5};
    s.add_bodies({&b, 1});
    s.advance(20000);
    const double t = s.time();
    ASSERT_NEAR(t, 0.2, 1e-12);
    const Vec3 expected = b.pose.position + b.velocity * t + 0.5 * d.gravity * t * t;
    // Velocity Verlet is exact for a constant force: only rounding is left (the gate of the literature is 1e-9).
    EXPECT_LT((s.bodies().position[0] - expected).norm(), 1e-12);
    EXPECT_LT((s.bodies().velocity[0] - (b.velocity + d.gravity * t)).norm(), 1e-12);
}

/// Peak rebound speed / impact speed of a sphere dropped on a plate.
double restitution_out(double e, double step) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(2e-3, 2000.0)};
    d.pellet_material = {1e7, 0.25};
    d.walls = {scene::wall("floor", scene::plate(0.05), {e, 0.0, 0.0})};
    d.gravity = Vec3::Zero();
    d.time_step = step;
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {0.001, 0.002, 2.001e-3};
    b.velocity = {0.0, 0.0, -0.5};
    s.add_bodies({&b, 1});
    s.advance(static_cast<std::uint64_t>(1.5e-3 / step));
    EXPECT_GT(s.bodies().position[0].z(), 2e-3);
    return s.bodies().velocity[0].z() / 0.5;
}

TEST(Motion, ReboundHasTheRestitutionThatWasAskedFor) {
    // The EDEM form may pull at the end of a contact; then e_out = e_in (solver design, section 4.2: to four digits). The pull ends at overlap
    // zero, which a finite step meets with an error of order one in the last step: 2e-3 at about 300 steps a contact.
    for (const double e : {1.0, 0.9, 0.8, 0.6, 0.4, 0.2}) EXPECT_NEAR(restitution_out(e, 5e-7), e, 2e-3) << e;
}

TEST(Motion, SlidingBallEndsRollingWithFiveSevenths) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(5e-3, 2500.0)};
    d.pellet_material = {1e7, 0.25};
    d.walls = {scene::wall("floor", scene::plate(1.0), {0.5, 0.3, 0.0})};
    d.time_step = 1e-5;
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {-0.5, 0.0, 5e-3};
    b.velocity = {1.0, 0.0, 0.0};
    s.add_bodies({&b, 1});
    s.advance(30000);  // sliding ends at 2 v0 / (7 μ g) = 0.097 s
    const Vec3 v = s.bodies().velocity[0], w = s.bodies().spin[0];
    // The lever of the friction force is r minus the overlap (about 1e-4 of r), hence 1e-3.
    EXPECT_NEAR(v.x(), 5.0 / 7.0, 1e-3);
    EXPECT_NEAR(w.y() * 5e-3, v.x(), 1e-3);
    EXPECT_NEAR(v.y(), 0.0, 1e-9);
}

TEST(Motion, SlidingPhaseLosesSpeedAtMuG) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(5e-3, 2500.0)};
    d.pellet_material = {1e7, 0.25};
    d.walls = {scene::wall("floor", scene::plate(1.0), {0.01, 0.3, 0.0})};
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {-0.5, 0.0, 5e-3 - 1e-6};
    b.velocity = {1.0, 0.0, 0.0};
    s.add_bodies({&b, 1});
    s.advance(3000);
    const double v1 = s.bodies().velocity[0].x();
    s.advance(4000);
    EXPECT_NEAR((v1 - s.bodies().velocity[0].x()) / 0.04, 0.3 * 9.81, 0.3 * 9.81 * 1e-4);  // the bounce of the drop has died out
}

TEST(Motion, RollingFrictionSlowsTheBallAsTypeA) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(5e-3, 2500.0)};
    d.pellet_material = {1e7, 0.25};
    const double mu_r = 0.05;
    d.walls = {scene::wall("floor", scene::plate(1.0), {0.01, 0.8, mu_r})};
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {-0.5, 0.0, 5e-3 - 1e-6};
    b.velocity = {0.5, 0.0, 0.0};
    b.spin = {0.0, 100.0, 0.0};
    s.add_bodies({&b, 1});
    s.advance(10000);
    const double v1 = s.bodies().velocity[0].x();
    s.advance(20000);
    const double v2 = s.bodies().velocity[0].x();
    // Ai et al. 2011, test A: a = (5/7) μ_r g while rolling (gate 0.5 %).
    EXPECT_NEAR((v1 - v2) / 0.2, 5.0 / 7.0 * mu_r * 9.81, 5.0 / 7.0 * mu_r * 9.81 * 5e-3);
    s.advance(130000);
    EXPECT_LT(s.energy().kinetic_translation, 1e-12 * 0.5 * d.templates[0].mass_properties.mass * 0.25);  // comes to rest without chattering
}

struct FreeTop {
    explicit FreeTop(const Vec3& inertia, double step) {
        SimulationDefinition d;
        RigidTemplate t = scene::cylinder_template(3, 8);
        t.mass_properties.principal_inertia = inertia;
        d.templates = {t};
        d.pellet_material.shear_modulus = 1e-6;  // nothing touches: the step is limited by the accuracy of rotation alone
        d.gravity = Vec3::Zero();
        d.time_step = step;
        simulation = std::make_unique<Simulation>(d);
        BodyPlacement b;
        b.spin = {30.0, 40.0, 120.0};
        simulation->add_bodies({&b, 1});
    }
    Vec3 angular_momentum() const {
        const Mat3 r = simulation->bodies().orientation[0].toRotationMatrix();
        return r * simulation->definition().templates[0].mass_properties.principal_inertia.cwiseProduct(r.transpose() * simulation->bodies().spin[0]);
    }
    std::unique_ptr<Simulation> simulation;
};

TEST(Motion, FreePelletKeepsAngularMomentumAndEnergy) {
    const Vec3 inertia = scene::cylinder_template(3, 8).mass_properties.principal_inertia;
    FreeTop top(inertia, 1e-5);
    const double l0 = top.angular_momentum().norm(), e0 = top.simulation->energy().kinetic_rotation;
    const double angle0 = (top.simulation->bodies().orientation[0] * Vec3::UnitZ()).dot(top.angular_momentum() / l0);
    const double phase_rate = l0 / inertia.x();
    double worst_l = 0.0, worst_e = 0.0, worst_angle = 0.0;
    for (int k = 0; k < 100; ++k) {
        top.simulation->advance(10000);
        worst_l = std::max(worst_l, std::abs(top.angular_momentum().norm() / l0 - 1.0));
        worst_e = std::max(worst_e, std::abs(top.simulation->energy().kinetic_rotation / e0 - 1.0));
        worst_angle = std::max(worst_angle, std::abs((top.simulation->bodies().orientation[0] * Vec3::UnitZ()).dot(top.angular_momentum() / l0) - angle0));
    }
    EXPECT_LT(worst_l, 1e-10);
    EXPECT_LT(worst_e, 1e-10);
    EXPECT_LT(worst_angle, 1e-10);
    // The axis precesses about L at |L| / I_perp: compare with the exact turn of the first axis direction.
    const Vec3 l = top.angular_momentum() / l0;
    const Vec3 expected = Eigen::AngleAxisd(std::fmod(phase_rate * top.simulation->time(), 2.0 * M_PI), l) * Vec3::UnitZ();
    EXPECT_LT((top.simulation->bodies().orientation[0] * Vec3::UnitZ() - expected).norm(), 1e-7);  // 1e6 steps of rounding in a phase of 1500 rad
}

TEST(Motion, AsymmetricTopIsOfSecondOrder) {
    const Vec3 inertia(3e-11, 5e-11, 6.5e-11);
    const auto end = [&](double step) {
        FreeTop top(inertia, step);
        top.simulation->advance(static_cast<std::uint64_t>(std::llround(0.02 / step)));
        return top.simulation->bodies().orientation[0];
    };
    const Quat reference = end(1e-6), coarse = end(4e-5), fine = end(2e-5);
    const double error_coarse = coarse.angularDistance(reference), error_fine = fine.angularDistance(reference);
    EXPECT_GT(error_coarse, 1e-9);
    EXPECT_NEAR(std::log2(error_coarse / error_fine), 2.0, 0.05);
}

TEST(Motion, AsymmetricTopKeepsEnergyWithoutDrift) {
    FreeTop top({3e-11, 5e-11, 6.5e-11}, 1e-5);
    const double l0 = top.angular_momentum().norm(), e0 = top.simulation->energy().kinetic_rotation;
    double early = 0.0, late = 0.0;
    for (int k = 0; k < 100; ++k) {
        top.simulation->advance(1000);
        const double error = std::abs(top.simulation->energy().kinetic_rotation / e0 - 1.0);
        (k < 50 ? early : late) = std::max(k < 50 ? early : late, error);
    }
    EXPECT_LT(std::abs(top.angular_momentum().norm() / l0 - 1.0), 1e-12);
    EXPECT_LT(early, 1e-6);        // (ω Δt)² = 1e-6: the splitting oscillates with that size
    EXPECT_LT(late, 1.2 * early);  // and does not drift
}

TEST(Motion, FreeRotationTakesLargeAngles) {
    FreeTop slow(Vec3::Constant(5e-11), 1e-5), fast(Vec3::Constant(5e-11), 2e-2);  // 2.6 rad a step
    slow.simulation->advance(4000);
    fast.simulation->advance(2);
    EXPECT_LT(slow.simulation->bodies().orientation[0].angularDistance(fast.simulation->bodies().orientation[0]), 1e-9);
}

}  // namespace
}  // namespace pelletlab::solver
