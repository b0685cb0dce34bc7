// Wrong definitions, wrong placements and runs that go wrong: each is one clear error.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <new>

#include "../../verification/solver/scene.hpp"
#include "core/error.hpp"

namespace pelletlab::solver {
namespace {

SimulationDefinition sound() {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(1e-3, 2000.0)};
    d.walls = {scene::wall("floor", scene::plate(0.05), {0.4, 0.5, 0.05})};
    return d;
}

void expect_error(ErrorKind kind, const std::string& word, const std::function<void()>& work) {
    try {
        work();
        FAIL() << "no error that says " << word;
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind);
        EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
        EXPECT_FALSE(e.remedy().empty());
    }
}

TEST(Definition, BadOnesAreRefused) {
    const auto refuse = [](const std::string& word, const std::function<void(SimulationDefinition&)>& spoil) {
        SimulationDefinition d = sound();
        spoil(d);
        expect_error(ErrorKind::bad_input, word, [&] { Simulation s(d); });
    };
    refuse("no pellet template", [](auto& d) { d.templates.clear(); });
    refuse("no spheres", [](auto& d) { d.templates[0].spheres.clear(); });
    refuse("positive radius", [](auto& d) { d.templates[0].spheres[0].radius = 0.0; });
    refuse("positive mass", [](auto& d) { d.templates[0].mass_properties.mass = -1.0; });
    refuse("no body can have", [](auto& d) { d.templates[0].mass_properties.principal_inertia = {1.0, 1.0, 3.0}; });
    refuse("time step must be positive", [](auto& d) { d.time_step = 0.0; });
    refuse("unstable", [](auto& d) { d.time_step = 1e-2; });
    refuse("shear modulus", [](auto& d) { d.pellet_material.shear_modulus = 0.0; });
    refuse("Poisson", [](auto& d) { d.walls[0].material.poisson_ratio = 0.6; });
    refuse("restitution", [](auto& d) { d.pellet_contact.restitution = 1.5; });
    refuse("sliding friction", [](auto& d) { d.walls[0].contact.sliding_friction = -0.1; });
    refuse("rolling friction", [](auto& d) { d.pellet_contact.rolling_friction = std::nan(""); });
    refuse("two walls", [](auto& d) { d.walls.push_back(d.walls[0]); });
    refuse("axis of length 1", [](auto& d) { d.walls[0].motion.axis = {0, 2, 0}; });
    refuse("no triangles", [](auto& d) { d.walls[0].mesh = {}; });
    refuse("feature angle", [](auto& d) { d.walls[0].feature_angle = 4.0; });
}

TEST(AddBodies, OverlapsAreRefusedAndNothingIsAdded) {
    Simulation s(sound());
    std::vector<BodyPlacement> good(1);
    good[0].pose.position = {0, 0, 0.01};
    s.add_bodies(good);
    std::vector<BodyPlacement> b(2);
    b[0].pose.position = {0.02, 0, 0.01};
    b[1].pose.position = {0.0, 1.8e-3, 0.01};
    expect_error(ErrorKind::bad_input, "bodies 0 and 2 overlap by 20 %", [&] { s.add_bodies(b); });
    EXPECT_EQ(s.bodies().size(), 1u);
    b[1].pose.position = {0.03, 0, 0.9e-3};
    expect_error(ErrorKind::bad_input, "overlaps wall «floor» by 10", [&] { s.add_bodies(b); });
    b[1].pose.position = {0.03, 0, 0.97e-3};
    s.add_bodies(b);  // 3 % is allowed
    EXPECT_EQ(s.bodies().size(), 3u);
    s.advance(10);
}

TEST(AddBodies, BadPlacementsAreRefused) {
    Simulation s(sound());
    const auto refuse = [&](const std::string& word, const std::function<void(BodyPlacement&)>& spoil) {
        BodyPlacement b;
        b.pose.position = {0, 0, 0.01};
        spoil(b);
        expect_error(ErrorKind::bad_input, word, [&] { s.add_bodies({&b, 1}); });
    };
    refuse("template", [](auto& b) { b.template_index = 1; });
    refuse("finite", [](auto& b) { b.velocity.x() = std::nan(""); });
    refuse("unit quaternion", [](auto& b) { b.pose.orientation = Quat(0, 0, 0, 0); });
    refuse("outside the domain", [](auto& b) { b.pose.position.x() = 100.0; });
    EXPECT_EQ(s.bodies().size(), 0u);
}

TEST(Run, ABodyThatLeavesTheDomainIsNamedWithPlaceAndTime) {
    SimulationDefinition d = sound();
    d.domain = Box(Vec3(-0.1, -0.1, -0.01), Vec3(0.1, 0.1, 0.1));
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    b[0].pose.position = {0, 0, 0.02};
    b[1].pose.position = {0.09, 0, 0.02};
    b[1].velocity = {1.0, 0.0, 0.0};
    s.add_bodies(b);
    expect_error(ErrorKind::numerical, "body 1 left the domain", [&] { s.advance(2000); });
    EXPECT_NEAR(s.time(), 0.01, 1e-4);
}

TEST(Run, ABodyThatIsNoNumberAnyMoreIsNamedWithTimeAndStep) {
    SimulationDefinition d = sound();
    d.gravity = {0.0, 0.0, -1e308};  // speed and place overflow after some steps
    d.walls.clear();
    d.domain = Box(Vec3::Constant(-std::numeric_limits<double>::max()), Vec3::Constant(std::numeric_limits<double>::max()));
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    b[1].pose.position = {1.0, 0, 0};
    b[1].spin = {0, 0, 3.0};
    s.add_bodies(b);
    expect_error(ErrorKind::numerical, "body 0 has a position or a spin that is not a number", [&] { s.advance(3000000); });
    expect_error(ErrorKind::numerical, "step", [&] { s.advance(1); });
}

TEST(Run, AWallThatJumpsIsRefused) {
    SimulationDefinition d = sound();
    Simulation s(d);
    s.advance(5);
    WallMotion m;
    m.velocity = {0.0, 0.0, 101.0};  // 1.01 mm in a step of 10 µs; the sphere has 1 mm
    expect_error(ErrorKind::bad_input, "wall «floor» jumps: from time 5e-05 s on it moves by up to 0.00101 m", [&] { s.set_wall_motion(0, m); });
    m.velocity = Vec3::Zero();
    m.axis = Vec3::UnitZ();
    m.rotation_speed = 1500.0;  // the corners of the plate are 71 mm from the axis
    expect_error(ErrorKind::bad_input, "jumps", [&] { s.set_wall_motion(0, m); });
    s.advance(5);
    EXPECT_EQ(s.wall_poses()[0].position, Vec3::Zero());  // nothing has happened
    d.walls[0].motion = m;
    expect_error(ErrorKind::bad_input, "jumps", [&] { Simulation other(d); });
}

TEST(Run, AddingBodiesLaterKeepsTheOnesThatAreThere) {
    Simulation s(sound());
    std::vector<BodyPlacement> b(1);
    b[0].pose.position = {0, 0, 0.005};
    b[0].velocity = {0.1, 0, 0};
    s.add_bodies(b);
    s.advance(3000);
    const Vec3 position = s.bodies().position[0], velocity = s.bodies().velocity[0];
    b[0].pose.position = {0.01, 0.01, 0.005};
    s.add_bodies(b);
    EXPECT_EQ(s.bodies().position[0], position);
    EXPECT_EQ(s.bodies().velocity[0], velocity);
    s.advance(3000);
    EXPECT_EQ(s.bodies().size(), 2u);
}

TEST(Run, AnEmptySimulationSteps) {
    Simulation s(sound());
    s.advance(10);
    EXPECT_EQ(s.step_count(), 10u);
    EXPECT_EQ(s.contacts().wall_contacts, 0u);
}

TEST(Run, WallsMoveRigidlyAndExactly) {
    SimulationDefinition d = sound();
    Simulation s(d);
    WallMotion m;
    m.point = {0.01, 0.0, 0.0};
    m.axis = Vec3::UnitZ();
    m.rotation_speed = 2.0;
    m.velocity = {0.0, 0.0, 0.1};
    s.set_wall_motion(0, m);
    s.advance(1000);
    const Pose pose = s.wall_poses()[0];
    const Vec3 p(0.02, 0.01, 0.0);
    const Vec3 expected = m.point + Eigen::AngleAxisd(2.0 * 0.01, Vec3::UnitZ()) * (p - m.point) + m.velocity * 0.01;
    EXPECT_LT((pose.to_world(p) - expected).norm(), 1e-15);
}

TEST(ExactSurfaces, HaveNoNumbersThatWereNeverSet) {
    // Built on memory full of NaN: every member of every kind must be a number.
    alignas(ExactSurface) unsigned char memory[sizeof(ExactSurface)];
    const auto check = [&](auto make) {
        std::memset(memory, 0xff, sizeof memory);
        const auto* s = new (memory) ExactSurface(make());
        EXPECT_TRUE(s->point.allFinite() && s->axis.allFinite() && s->start.allFinite() && s->end.allFinite() && s->half_size.allFinite());
    };
    check([] { return exact_plane(Vec3::Zero(), Vec3::UnitY()); });
    check([] { return exact_cylinder(Vec3::Zero(), Vec3::UnitY(), 1.0, 0.0, 1.0); });
    check([] { return exact_disc(Vec3::Zero(), Vec3::UnitY(), 1.0); });
    check([] { return exact_box(-Vec3::Ones(), Vec3::Ones()); });
    check([] { return ExactSurface(); });
}

}  // namespace
}  // namespace pelletlab::solver
