// Mesh walls against what they stand for.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene.hpp"
#include "wall_meshes.hpp"

namespace pelletlab::solver {
namespace {

/// Trajectory of a spinning, bouncing, sliding clump on a plate.
std::vector<Vec3> bounce_path(TriangleMesh mesh, const RigidTemplate& pellet) {
    SimulationDefinition d;
    d.templates = {pellet};
    d.walls = {scene::wall("floor", std::move(mesh), {0.7, 0.5, 0.02})};
    d.domain = Box(Vec3::Constant(-1.0), Vec3::Constant(1.0));
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {-3.3e-3, 1.7e-3, 2.6e-3};
    b.pose.orientation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    b.velocity = {0.2, 0.1, -0.3};
    b.spin = {50.0, -30.0, 20.0};
    s.add_bodies({&b, 1});
    std::vector<Vec3> path;
    for (int k = 0; k < 50; ++k) {
        s.advance(20);
        path.push_back(s.bodies().position[0]);
    }
    return path;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double most = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, (a[k] - b[k]).norm());
    return most;
}

class PlanePellets : public testing::TestWithParam<int> {
protected:
    static RigidTemplate pellet() { return GetParam() == 1 ? scene::sphere_template(1.5e-3, 1800.0) : scene::cylinder_template(3, 8); }
};

TEST_P(PlanePellets, TriangulationOfAPlaneDoesNotMatter) {
    const std::vector<Vec3> one = bounce_path(scene::plate(0.05), pellet());
    double height = one.front().z();
    for (const Vec3& p : one) height = std::min(height, p.z());
    ASSERT_LT(height, 2.2e-3);  // it did touch
    // Position error 1e-12 m on a path of centimetres after contacts that lose about one digit.
    EXPECT_LT(largest_difference(one, bounce_path(scene::shuffled(scene::plate(0.05), 5), pellet())), 1e-12);
    EXPECT_LT(largest_difference(one, bounce_path(scene::shuffled(scene::plate(0.05, 40), 6), pellet())), 1e-12);
    EXPECT_LT(largest_difference(one, bounce_path(scene::shuffled(scene::plate(0.05, 97), 7), pellet())), 1e-12);  // triangles smaller than spheres
}

INSTANTIATE_TEST_SUITE_P(Wall, PlanePellets, testing::Values(1, 24));

TEST(Wall, RandomTriangulationEqualsPlane) {
    // Interior vertices moved within the plane.
    TriangleMesh mesh = scene::plate(0.05, 60);
    RandomStream random(11, 0);
    for (Vec3& v : mesh.vertices)
        if (std::abs(v.x()) < 0.0499 && std::abs(v.y()) < 0.0499) v += Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0.0) * 4e-4;
    const RigidTemplate pellet = scene::cylinder_template(3, 8);
    EXPECT_LT(largest_difference(bounce_path(scene::plate(0.05), pellet), bounce_path(scene::shuffled(mesh, 8), pellet)), 1e-12);
}

/// A plane that leans in space, cut at random: points at random places, each put into the triangle that holds it, so that slivers abound.
TEST(Wall, RandomCutsWithSliversAreTheirPlane) {
    const Pose lean{{1e-3, -2e-3, 5e-4}, Quat(Eigen::AngleAxisd(0.4, Vec3(3, -1, 2).normalized()))};
    const auto path_on = [&](const TriangleMesh& mesh, double radius) {
        SimulationDefinition d;
        d.templates = {scene::sphere_template(radius, 1800.0)};
        d.walls = {scene::wall("floor", transformed(mesh, lean), {0.7, 0.5, 0.02})};
        d.domain = Box(Vec3::Constant(-1.0), Vec3::Constant(1.0));
        d.gravity = lean.orientation * Vec3(0.5, 0.2, -9.8);
        Simulation s(d);
        BodyPlacement b;
        b.pose.position = lean.to_world({-0.010, 0.004, radius + 2e-4});
        b.velocity = lean.orientation * Vec3(0.2, -0.1, -0.2);
        b.spin = {50.0, -30.0, 20.0};
        s.add_bodies({&b, 1});
        std::vector<Vec3> path;
        for (int k = 0; k < 60; ++k) {
            s.advance(50);
            path.push_back(s.bodies().position[0]);
        }
        return path;
    };
    // A sliver's normal is as good as its height is long against the rounding of its corners (1e-17 m): 1e-7 m gives 1e-10 rad, on the length of a
    // radius less than 1e-12 m. Narrower ones are counted in the wall's report and stay out of this test.
    const TriangleMesh cut = scene::random_cut(0.05, 3000, 1e-7, 21);
    const std::size_t slivers = inspect_wall(cut).slivers;
    EXPECT_GT(slivers, 20u);
    EXPECT_EQ(inspect_wall(cut).border_edges, 4u);
    EXPECT_EQ(inspect_wall(cut).patches, 1u);
    for (const double radius : {5e-4, 2e-3, 1e-2}) {  // as large as the triangles, four times, twenty times
        const std::vector<Vec3> one = path_on(scene::plate(0.05), radius);
        const double least = (lean.to_body(*std::min_element(one.begin(), one.end(), [&](const Vec3& p, const Vec3& q) {
                                 return lean.to_body(p).z() < lean.to_body(q).z();
                             }))).z();
        ASSERT_LT(least, radius);  // it did touch
        EXPECT_LT(largest_difference(one, path_on(scene::shuffled(cut, 3), radius)), 1e-12) << radius;
    }
}

TEST(Wall, RollingOverSeamsOfARefinedPlaneKeepsTheHistory) {
    const auto roll = [](int n) {
        SimulationDefinition d;
        d.templates = {scene::sphere_template(2e-3, 2000.0)};
        d.walls = {scene::wall("floor", scene::plate(0.2, n), {0.5, 0.4, 0.0})};
        Simulation s(d);
        BodyPlacement b;
        b.pose.position = {-0.05, 0.0101, 2e-3};
        b.velocity = {0.3, 0.05, 0.0};
        s.add_bodies({&b, 1});
        s.advance(20000);
        return s.bodies().position[0];
    };
    EXPECT_LT((roll(1) - roll(100)).norm(), 1e-11);
}

TEST(Wall, CornersOfABoxPushTwiceOrThrice) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(2e-3, 2000.0)};
    d.walls = {scene::wall("box", scene::box(Vec3::Zero(), Vec3::Constant(0.05)), {0.5, 0.4, 0.0})};
    d.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
    Simulation s(d);
    std::vector<BodyPlacement> b(3);
    const double touch = 2e-3 - 5e-5;
    b[0].pose.position = {touch, 0.01, 0.02};           // one face
    b[1].pose.position = {touch, touch, 0.02};          // two faces
    b[2].pose.position = {touch, touch, 0.05 - touch};  // three
    b[1].pose.position.z() = 0.03;
    s.add_bodies(b);
    std::vector<int> count(3, 0);
    for (const ContactPoint& c : s.contact_points()) ++count[c.body_i];
    EXPECT_EQ(count, (std::vector<int>{1, 2, 3}));
}

/// Fraction of places on the inside of a drum where the force differs from that of one facet by more than a little.
TEST(Wall, DrumSeamsDoNotPushTwice) {
    const double big_r = 0.1, r = 1e-3, overlap = 1e-5;
    for (const int facets : {24, 120, 400, 1200}) {
        SimulationDefinition d;
        d.templates = {scene::sphere_template(r, 2000.0)};
        d.walls = {scene::wall("drum", scene::tube(big_r, 0.05, facets), {1.0, 0.0, 0.0})};
        d.gravity = Vec3::Zero();
        Simulation s(d);
        std::vector<BodyPlacement> b;
        const double apothem = big_r * std::cos(M_PI / facets);
        for (int k = 0; k < 200; ++k) {
            // On circles that touch the facets' planes: rho such that the nearest plane is overlapped by `overlap`.
            const double angle = 2.0 * M_PI * (k + 0.37) / 200.0, from_mid = std::remainder(angle - M_PI / facets, 2.0 * M_PI / facets);
            const double rho = (apothem - r + overlap) / std::cos(from_mid);
            b.push_back({0, {{rho * std::cos(angle), 0.013, rho * std::sin(angle)}, Quat::Identity()}, Vec3::Zero(), Vec3::Zero()});
        }
        s.add_bodies(b);
        EXPECT_EQ(s.contacts().wall_contacts, b.size()) << facets;
        const double expected = s.bodies().force[0].norm();
        for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(s.bodies().force[i].norm(), expected, 1e-6 * expected) << facets << " " << i;
    }
}

TEST(Wall, RotatingDrumDragsByItsSurfaceSpeed) {
    // Gravity-free sphere held at the wall by its own inertia is too complicated; a sphere lying in a slowly turning drum with large friction rolls: its
    // centre stays near the bottom and it spins with w r = −W R.
    SimulationDefinition d;
    const double big_r = 0.05, r = 2e-3, speed = 1.0;
    d.templates = {scene::sphere_template(r, 2000.0)};
    WallDefinition drum = scene::wall("drum", scene::tube(big_r, 0.02, 720), {0.1, 0.8, 0.0});
    drum.motion.rotation_speed = speed;
    d.walls = {drum};
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {0.0, 0.0, -(big_r - r)};
    s.add_bodies({&b, 1});
    s.advance(100000);
    // The wall at the bottom moves with ω × r = (0, W, 0) × (0, 0, −R) = (−W R, 0, 0); rolling without slip: v + w × (0, 0, −r) = that.
    const double surface = -speed * big_r;
    const double patch_speed = s.bodies().velocity[0].x() - s.bodies().spin[0].y() * r;
    EXPECT_NEAR(patch_speed, surface, 0.02 * std::abs(surface));
}

TEST(Wall, LoadsOfTheWallBalanceTheBed) {
    SimulationDefinition d = scene::falling_definition(scene::cylinder_template(2, 8));
    Simulation s(d);
    s.add_bodies(scene::lattice(4, 4, 3, 4.6e-3, 2));
    s.advance(40000);
    const double weight = 48.0 * d.templates[0].mass_properties.mass * 9.81;
    EXPECT_NEAR(s.wall_loads()[0].force.z(), -weight, 0.02 * weight);  // the bed still creeps a little
}

TEST(Wall, WallForceIsTheNegativeSumOverBodiesToRounding) {
    SimulationDefinition d = scene::falling_definition(scene::cylinder_template(2, 8));
    Simulation s(d);
    s.add_bodies(scene::lattice(4, 4, 3, 4.6e-3, 2));
    s.advance(5000);
    Vec3 total = Vec3::Zero(), torque = Vec3::Zero();
    for (std::size_t i = 0; i < s.bodies().size(); ++i) {
        const Vec3 f = s.bodies().force[i] - d.gravity * d.templates[0].mass_properties.mass;
        total += f;
        torque += s.bodies().torque[i] + s.bodies().position[i].cross(f);
    }
    EXPECT_GT(total.norm(), 1e-4);
    EXPECT_LT((total + s.wall_loads()[0].force).norm(), 1e-12 * total.norm() + 1e-15);
    EXPECT_LT((torque + s.wall_loads()[0].torque).norm(), 1e-10 * torque.norm() + 1e-16);
}

}  // namespace
}  // namespace pelletlab::solver
