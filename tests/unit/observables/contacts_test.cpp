// Contacts in frames whose overlaps are set: counts and Hertz forces are formulas.
#include "observables/contacts.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;
using namespace pelletlab::synthetic;

namespace {

const TubeGeometry tube{20e-3, 0.0, 1e-3};
constexpr double radius = 2e-3, modulus = 3e6;

double find(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o.value;
    throw std::runtime_error("no observable " + name);
}

double hertz(double stiffness, double reduced_radius, double overlap) {
    return 4.0 / 3.0 * stiffness * std::sqrt(reduced_radius) * std::pow(overlap, 1.5);
}

/// A square floor of two triangles that meet under the tube's axis, and a shell of `facets` flat sides around the circle.
std::vector<WallShape> walls_of_tube(std::uint32_t facets) {
    WallShape floor{"floor", {{{-0.1, -0.1, 0.0}, {0.1, -0.1, 0.0}, {0.1, 0.1, 0.0}, {-0.1, 0.1, 0.0}}, {{0, 1, 2}, {0, 2, 3}}}}, shell{"shell", {}};
    const double outside = tube.radius / std::cos(pi / facets);
    for (std::uint32_t k = 0; k < facets; ++k) {
        const double angle = 2.0 * pi * k / facets;
        for (const double z : {0.0, 0.05}) shell.mesh.vertices.emplace_back(outside * std::cos(angle), outside * std::sin(angle), z);
        const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % facets);
        shell.mesh.faces.push_back({a, b, b + 1});
        shell.mesh.faces.push_back({a, b + 1, a + 1});
    }
    return {shell, floor};
}

Trajectory with_walls(const PelletShape& shape, Frame frame) {
    Trajectory trajectory = trajectory_of(shape, {frame});
    trajectory.head.walls = walls_of_tube(64);
    trajectory.frames[0].wall_poses.resize(2);
    return trajectory;
}

}  // namespace

TEST(FrameContacts, ModulusOfTwoMaterials) {
    // Equal ones: E* = G / (1 − ν). Against something rigid: twice that.
    EXPECT_NEAR(effective_modulus(2e6, 0.25, 2e6, 0.25), 2e6 / 0.75, 1e-6);
    EXPECT_NEAR(effective_modulus(2e6, 0.25, 1e30, 0.25), 2.0 * 2e6 / 0.75, 1e-6);
}

TEST(FrameContacts, SpheresOnTheFloorAndAgainstTheShell) {
    // A chain of three along x with overlaps of 10 and 20 µm; the first presses 5 µm into the floor, a fourth 8 µm into the middle of a facet of the shell
    // (the circle touches facets there), a fifth floats.
    Frame frame;
    const double facet = pi / 64.0;
    add_body(frame, {0.0, 0.0, radius - 5e-6});
    add_body(frame, {2.0 * radius - 10e-6, 0.0, radius - 5e-6 + 1e-3});
    frame.positions[1] = Vec3((2.0 * radius - 10e-6) * std::cos(0.5), 0.0, radius - 5e-6 + (2.0 * radius - 10e-6) * std::sin(0.5));
    add_body(frame, frame.positions[1] + Vec3(0.0, 2.0 * radius - 20e-6, 0.0));
    add_body(frame, Vec3(-(tube.radius - radius + 8e-6) * std::cos(facet), -(tube.radius - radius + 8e-6) * std::sin(facet), 10e-3));
    add_body(frame, {0.0, -10e-3, 20e-3});
    const Trajectory trajectory = with_walls(sphere_pellet(radius), frame);
    const ContactStiffness stiffness{true, modulus, {2.0 * modulus, 5.0 * modulus}};
    const double weak = hertz(modulus, 0.5 * radius, 10e-6), strong = hertz(modulus, 0.5 * radius, 20e-6);
    const double weight = 5.0 * trajectory.head.shapes[0].rigid.mass_properties.mass * 9.81;
    for (const TubeSurface surface : {TubeSurface::triangles, TubeSurface::exact}) {
        Observables found;
        add_frame_contacts(found, trajectory, tube, surface, stiffness);
        expect_documented(found);
        EXPECT_NEAR(find(found, "touching_neighbours"), 4.0 / 5.0, 1e-12);
        EXPECT_NEAR(find(found, "sphere_contacts_per_pellet"), 2.0 / 5.0, 1e-12);
        EXPECT_NEAR(find(found, "wall_contacts_per_pellet"), 2.0 / 5.0, 1e-12);
        EXPECT_NEAR(find(found, "loose_pellet_share"), 3.0 / 5.0, 1e-12) << "the end of the chain, the one at the shell and the floating one";
        EXPECT_NEAR(find(found, "contact_force_mean"), 0.5 * (weak + strong) * 1e3, 1e-8 * strong * 1e3);  // 10 µm of 4 mm, from coordinates good to 1e-18 m
        EXPECT_NEAR(find(found, "contact_force_max"), strong * 1e3, 1e-8 * strong * 1e3);
        EXPECT_NEAR(find(found, "contact_force_over_weight"), 0.5 * (weak + strong) / (weight / 5.0), 1e-7);
        EXPECT_NEAR(find(found, "floor_elastic_share"), hertz(5.0 * modulus, radius, 5e-6) / weight, 1e-8 * hertz(5.0 * modulus, radius, 5e-6) / weight);
        ASSERT_EQ(found.profiles.size(), 2u);
        const std::vector<double> neighbours{0.4, 0.4, 0.2};
        ASSERT_EQ(found.profiles[0].value.size(), neighbours.size());
        for (std::size_t k = 0; k < neighbours.size(); ++k) EXPECT_NEAR(found.profiles[0].value[k], neighbours[k], 1e-12);
        double sum = 0.0;
        for (const double density : found.profiles[1].value) sum += 0.25 * density;
        EXPECT_NEAR(sum, 1.0, 1e-12);
    }
}

TEST(FrameContacts, AWallCountsASphereOnceWhereItIsDeepest) {
    // In the corner between floor and an edge of the shell: both walls, each once, though the sphere reaches two facets and both triangles of the floor.
    Frame frame;
    const double inside = tube.radius - radius + 30e-6;
    add_body(frame, {inside, 0.0, radius - 5e-6});
    add_body(frame, {0.0, 0.0, radius - 5e-6});
    Observables found;
    add_frame_contacts(found, with_walls(sphere_pellet(radius), frame), tube, TubeSurface::triangles, std::nullopt);
    EXPECT_NEAR(find(found, "wall_contacts_per_pellet"), 3.0 / 2.0, 1e-12);
    EXPECT_NEAR(find(found, "loose_pellet_share"), 1.0 / 2.0, 1e-12) << "the one in the corner has two walls";
    EXPECT_EQ(found.values.size(), 4u) << "no forces without stiffness";
}

TEST(FrameContacts, ContactsOfAClumpAddUpAsVectors) {
    // A dumbbell whose two spheres press equally on one sphere between them from both sides of 60°: two sphere contacts, one neighbour, F = 2 f cos 60°.
    PelletShape shape = sphere_pellet(radius);
    const double apart = 2.0 * radius - 10e-6;  // of centres in contact
    const double half = apart * std::sin(pi / 3.0);
    shape.rigid.spheres = {{Vec3(-half, 0.0, 0.0), radius}, {Vec3(half, 0.0, 0.0), radius}};
    shape.rigid.bounding_radius = half + radius;
    Trajectory trajectory = with_walls(shape, {});
    trajectory.head.shapes.push_back(sphere_pellet(radius));
    trajectory.head.shape_of_body = {0, 1};
    add_body(trajectory.frames[0], {0.0, 0.0, 10e-3});
    add_body(trajectory.frames[0], {0.0, 0.0, 10e-3 + apart * std::cos(pi / 3.0)});
    Observables found;
    add_frame_contacts(found, trajectory, tube, TubeSurface::triangles, ContactStiffness{true, modulus, {modulus, modulus}});
    EXPECT_NEAR(find(found, "sphere_contacts_per_pellet"), 1.0, 1e-12);
    EXPECT_NEAR(find(found, "touching_neighbours"), 1.0, 1e-12);
    const double each = hertz(modulus, 0.5 * radius, 10e-6);
    EXPECT_NEAR(find(found, "contact_force_mean"), each * 1e3, 1e-8 * each * 1e3);  // 2 · 1/2
    // Linear springs: the same geometry, F = k δ each.
    Observables linear;
    add_frame_contacts(linear, trajectory, tube, TubeSurface::triangles, ContactStiffness{false, 1e4, {1e4, 1e4}});
    EXPECT_NEAR(find(linear, "contact_force_mean"), 1e4 * 10e-6 * 1e3, 1e-8);
}

TEST(FrameContacts, PelletsWithoutSpheresAreAnError) {
    Frame frame;
    add_body(frame, {0.0, 0.0, 5e-3});
    Observables found;
    EXPECT_THROW(add_frame_contacts(found, trajectory_of(box_pellet(1e-3, 1e-3), {frame}), tube, TubeSurface::triangles, std::nullopt), Error);
}
