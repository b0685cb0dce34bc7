// Options of the physics: what is refused, and what walls in closed form and prescribed motions do.
#include <gmock/gmock.h>

#include "../../verification/solver/scene.hpp"
#include "core/error.hpp"

namespace pelletlab::solver {
namespace {

template <class Change>
void refuse(const std::string& words, const Change& change) {
    SimulationDefinition d = scene::falling_definition(scene::cylinder_template(2, 6));
    change(d);
    try {
        Simulation s(d);
        ADD_FAILURE() << "accepted: " << words;
    } catch (const Error& error) {
        EXPECT_THAT(error.problem(), ::testing::HasSubstr(words));
    }
}

TEST(PhysicsOptions, OutOfRangeOrExcludingEachOtherAreRefused) {
    refuse("linear stiffness", [](auto& d) { d.physics.linear_stiffness = 0.0; });
    refuse("contact angle", [](auto& d) { d.physics.liquid.contact_angle = 1.6; });
    refuse("bridge volume", [](auto& d) { d.physics.liquid.bridge_volume = 0.0; });
    refuse("decay speed", [](auto& d) { d.physics.friction_decay_speed = -1.0; });
    refuse("ratio of kinetic", [](auto& d) { d.pellet_contact.kinetic_friction_ratio = 1.1; });
    refuse("work of adhesion", [](auto& d) { d.walls[0].contact.work_of_adhesion = -0.1; });
    refuse("at least 0.01", [](auto& d) { d.physics.contact = ContactModel::hertz_impulse_exact, d.pellet_contact.restitution = 0.0; });
    refuse("JKR cohesion needs a Hertz contact", [](auto& d) { d.physics.cohesion = Cohesion::jkr, d.physics.contact = ContactModel::linear; });
    refuse("cannot share", [](auto& d) { d.physics.cohesion = Cohesion::jkr, d.physics.clump_contacts = ClumpPolicy::shared; });
    refuse("body forces", [](auto& d) { d.body_forces.air.density = -1.0; });
    refuse("exact surface", [](auto& d) { d.walls[0].exact = exact_cylinder(Vec3::Zero(), Vec3::UnitZ(), 0.01, 0.0, 0.0); });
}

TEST(PhysicsOptions, WallsThatWouldJumpAreRefused) {
    refuse("jumps", [](auto& d) { d.walls[0].motion.velocity = {0, 0, 100.0}; });
    refuse("jumps", [](auto& d) { d.walls[0].motion.oscillation = {0, 0, 1.0}, d.walls[0].motion.frequency = 20.0; });
    refuse("begin at time 0", [](auto& d) { d.walls[0].motion.table = {{0.0, {0, 0, 0.1}, 0.0}, {1.0, {0, 0, 0.2}, 0.0}}; });
    refuse("not later", [](auto& d) { d.walls[0].motion.table = {{0.0, Vec3::Zero(), 0.0}, {0.0, {0, 0, 0.2}, 0.0}}; });
}

TEST(WallMotionFormula, VelocityIsTheDerivativeOfThePlaceAndTheTablePassesItsRows) {
    WallMotion m;
    m.velocity = {0.1, 0.0, 0.0};
    m.rotation_speed = 2.0;
    m.oscillation = {0.0, 1e-3, 0.0};
    m.swing = 0.1, m.frequency = 7.0, m.phase = 0.4;
    m.table = {{0.0, Vec3::Zero(), 0.0}, {0.1, {0, 0, 1e-3}, 0.2}, {0.15, {0, 0, 4e-3}, 0.1}, {0.4, {0, 0, 4e-3}, 0.3}};
    for (const double t : {0.03, 0.12, 0.149, 0.31, 0.5}) {
        const double h = 1e-6;
        const WallPlace before = place_at(m, t - h), now = place_at(m, t), after = place_at(m, t + h);
        EXPECT_LT((now.velocity - (after.shift - before.shift) / (2.0 * h)).norm(), 1e-7) << t;
        EXPECT_NEAR(now.angular_speed, (after.angle - before.angle) / (2.0 * h), 1e-6) << t;
    }
    WallMotion table_only;
    table_only.table = m.table;
    for (const MotionRow& row : m.table) {
        EXPECT_LT((place_at(table_only, row.time).shift - row.shift).norm(), 1e-15);
        EXPECT_NEAR(place_at(table_only, row.time).angle, row.angle, 1e-15);
    }
    EXPECT_EQ(place_at(m, 0.0).shift, Vec3::Zero());
    EXPECT_EQ(place_at(table_only, 1.0).velocity, Vec3::Zero());
}

/// Where pellets come to be between exact walls and between the same walls as meshes.
std::vector<Vec3> settled(bool exact) {
    SimulationDefinition d = scene::falling_definition(scene::cylinder_template(2, 6));
    if (exact) d.walls[0].exact = exact_box({-0.012, -0.012, 0.0}, {0.012, 0.012, 0.2});
    Simulation s(d);
    s.add_bodies(scene::lattice(3, 3, 2, 5e-3, 4));
    s.advance(1500);
    return s.bodies().position;
}

TEST(ExactWalls, BoxEqualsItsMesh) {
    const auto mesh = settled(false), exact = settled(true);
    for (std::size_t k = 0; k < mesh.size(); ++k) EXPECT_LT((mesh[k] - exact[k]).norm(), 1e-9) << k;  // rounding, grown by some hundred contact steps
}

/// Force of a wall on a sphere that overlaps it by 10 µm.
Vec3 force_of(const ExactSurface& surface, const Vec3& centre) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(1e-3, 2000.0)};
    d.gravity = Vec3::Zero();
    WallDefinition w = scene::wall("w", TriangleMesh{}, {0.5, 0.5, 0.0});
    w.exact = surface;
    d.walls = {w};
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = centre;
    s.add_bodies({&b, 1});
    return s.bodies().force[0];
}

TEST(ExactWalls, ForcesPointAwayFromTheSurface) {
    const double gap = 1e-3 - 1e-5, r = 0.02;
    const Vec3 plane = force_of(exact_plane({0, 0, 1}, {0, 0, 1}), {0.3, 0.2, 1.0 + gap});
    ASSERT_GT(plane.z(), 0.0);
    const auto same = [&](const Vec3& force, const Vec3& direction) { EXPECT_LT((force / plane.z() - direction).norm(), 1e-9); };
    same(force_of(exact_cylinder(Vec3::Zero(), Vec3::UnitY(), r, -1.0, 1.0), {r - gap, 0.1, 0.0}), {-1, 0, 0});
    same(force_of(exact_cylinder(Vec3::Zero(), Vec3::UnitY(), r, -1.0, 1.0), {0.0, 0.1, r + gap}), {0, 0, 1});
    same(force_of(exact_disc({0, 0, 0.5}, Vec3::UnitZ(), r), {0.01, 0.0, 0.5 - gap}), {0, 0, -1});
    // A cone of 45°, from inside: the normal is (−1, 0, 1)/√2 on the side of +x for radius = height.
    const Vec3 normal = Vec3(-1, 0, 1).normalized();
    same(force_of(exact_cone(Vec3::Zero(), Vec3::UnitZ(), 0.0, 0.0, 1.0, 1.0), Vec3(0.5, 0, 0.5) + normal * gap), normal);
    same(force_of(exact_box({-1, -1, -1}, {1, 1, 1}), {1.0 - gap, 0.3, 0.2}), {-1, 0, 0});
    same(force_of(exact_box({-1, -1, -1}, {1, 1, 1}), {1.0 - gap, 1.0 - gap, 0.2}), {-1, -1, 0});
    same(force_of(exact_box({-1, -1, -1}, {1, 1, 1}), Vec3(1, 1, 0) + Vec3(1, 1, 0).normalized() * gap), Vec3(1, 1, 0).normalized());
}

}  // namespace
}  // namespace pelletlab::solver
