// Joins of mesh walls: what a sphere feels where triangles meet. The rules are those of solver/detail/wall_mesh.hpp; the cases are the ones that other codes
// fail (DEME #73, PhasicFlow #242, Lethe PR #1746, MercuryDPM's large spheres on small triangles).
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "scene.hpp"
#include "wall_meshes.hpp"

namespace pelletlab::solver {
namespace {

constexpr double radius = 2e-3;

SimulationDefinition one_sphere(TriangleMesh mesh, PairParameters contact = {1.0, 0.0, 0.0}) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(radius, 2000.0)};
    d.walls = {scene::wall("wall", std::move(mesh), contact)};
    d.gravity = Vec3::Zero();
    return d;
}

/// Forces on spheres at these places, all in one simulation.
std::vector<Vec3> forces_at(const SimulationDefinition& d, const std::vector<Vec3>& centres) {
    Simulation s(d);
    std::vector<BodyPlacement> bodies(centres.size());
    for (std::size_t k = 0; k < centres.size(); ++k) bodies[k].pose.position = centres[k];
    s.add_bodies(bodies);
    return s.bodies().force;
}

constexpr double long_fold = 4.0;  // [m]: along a fold nothing changes, so the places of a sweep stand one behind the other, each with its own sphere

std::vector<Vec3> sweep(const SimulationDefinition& d, const std::function<Vec3(double)>& path, int places) {
    std::vector<Vec3> centres;
    for (int k = 0; k <= places; ++k) centres.push_back(path(static_cast<double>(k) / places) + Vec3(0.0, 2.2 * radius * (k - 0.5 * places), 0.0));
    return forces_at(d, centres);
}

double largest_of(const std::vector<Vec3>& forces) {
    double largest = 0.0;
    for (const Vec3& f : forces) largest = std::max(largest, f.norm());
    return largest;
}

double largest_step(const std::vector<Vec3>& forces) {
    double largest = 0.0;
    for (std::size_t k = 1; k < forces.size(); ++k) largest = std::max(largest, (forces[k] - forces[k - 1]).norm());
    return largest;
}

/// A continuous force changes four times less between places that are four times closer (two and a half allow for kinks); a jump
/// stays as large as it is.
void expect_continuous(const SimulationDefinition& d, const std::function<Vec3(double)>& path, const std::string& what) {
    const std::vector<Vec3> coarse = sweep(d, path, 300), fine = sweep(d, path, 1200);
    ASSERT_GT(largest_of(coarse), 0.0) << what;
    EXPECT_LT(largest_step(fine), std::max(largest_step(coarse) / 2.5, 1e-9 * largest_of(fine))) << what << ", of " << largest_of(fine) << " N";
}

/// Centre at `depth` inside reach of the nearer face of a fold along y, `along` from the fold.
Vec3 beside_valley(double bend, double along, double depth) {
    const double a = 0.5 * bend, side = along < 0.0 ? -1.0 : 1.0, h = radius - depth;
    // On the line that bisects the fold the two offset planes meet at height h / cos a; from there up along the nearer face.
    return {along * std::cos(a), 0.0, h / std::cos(a) + side * along * std::sin(a)};
}

class Joins : public testing::TestWithParam<double> {};  // the angle between the faces, in degrees

TEST_P(Joins, ForceIsContinuousInAValley) {
    const double bend = M_PI - GetParam() * M_PI / 180.0;
    const SimulationDefinition d = one_sphere(scene::fold(bend, 0.05, long_fold));
    for (const double depth : {2e-6, 2e-5, 7e-5}) {  // 0.1 to 3.5 % of the radius
        const double reach = std::min(1e-3, 40.0 * depth / bend);
        expect_continuous(
            d, [&](double u) { return beside_valley(bend, (2.0 * u - 1.0) * reach, depth); }, "along the faces, depth " + std::to_string(depth));
        // From where the depth is 1.3 to where it is the same again, deepest at the ends.
        const auto straight_across = [&](double u) {
            return Vec3(beside_valley(bend, 0.0, depth) + (2.0 * u - 1.0) * Vec3(0.3 * depth / std::sin(0.5 * bend), 0.0, 0.0));
        };
        expect_continuous(d, straight_across, "straight across, depth " + std::to_string(depth));
    }
}

TEST_P(Joins, ForceIsContinuousOverARidge) {
    const double bend = M_PI - GetParam() * M_PI / 180.0;
    const SimulationDefinition d = one_sphere(scene::fold(-bend, 0.05, long_fold));
    const double a = 0.5 * bend;
    for (const double depth : {2e-6, 2e-5, 8e-5}) {
        const double h = radius - depth;
        const auto round_the_edge = [&](double u) {  // up one face, round the edge, down the other
            const double w = 3.0 * u - 1.5;
            if (w < -0.5) return Vec3(Vec3(-std::sin(a), 0.0, std::cos(a)) * h + (w + 0.5) * 1e-3 * Vec3(std::cos(a), 0.0, std::sin(a)));
            if (w > 0.5) return Vec3(Vec3(std::sin(a), 0.0, std::cos(a)) * h + (w - 0.5) * 1e-3 * Vec3(std::cos(a), 0.0, -std::sin(a)));
            return Vec3(Vec3(std::sin(2.0 * w * a), 0.0, std::cos(2.0 * w * a)) * h);
        };
        expect_continuous(d, round_the_edge, "depth " + std::to_string(depth));
        // One contact of one depth all the way: the same force.
        const std::vector<Vec3> forces = sweep(d, round_the_edge, 300);
        for (const Vec3& f : forces) EXPECT_NEAR(f.norm(), forces[0].norm(), 1e-9 * forces[0].norm());
    }
}

INSTANTIATE_TEST_SUITE_P(Wall, Joins, testing::Values(90.0, 135.0, 160.0, 170.0, 179.0),
                         [](const auto& info) { return std::to_string(static_cast<int>(info.param)); });

TEST(Wall, AShallowValleyNeverPushesHarderThanItsDeeperFace) {
    // The fault of a finely cut drum in other codes: two faces that push nearly the same way, twice the force.
    for (const double bend : {0.4, 0.2, 0.05, 0.01, 1e-3, 1e-5}) {
        const SimulationDefinition d = one_sphere(scene::fold(bend, 0.05, long_fold));
        const auto path = [&](double u) { return beside_valley(bend, (2.0 * u - 1.0) * radius * std::max(bend, 0.01), 2e-5); };
        const std::vector<Vec3> forces = sweep(d, path, 300);
        const double alone = forces_at(d, {beside_valley(bend, 5e-3, 2e-5)})[0].norm();
        for (const Vec3& f : forces) EXPECT_NEAR(f.norm(), alone, 1e-9 * alone) << bend;
    }
}

TEST(Wall, OrderAndWindingOfTrianglesDoNotMatterOnACurvedWall) {
    // PhasicFlow #242. Spheres all over a hilly surface: faces, ridges, valleys and corners of every kind.
    const TriangleMesh hills = scene::hills(0.07, 70, 1.5e-3, 3);
    SimulationDefinition d = one_sphere(hills);
    std::vector<Vec3> centres;
    for (int k = 0; k < 900; ++k) {
        RandomStream random(17, static_cast<std::uint64_t>(k));
        const Vec3 place((k % 30 - 14.5) * 2.1 * radius + random.uniform(-1e-4, 1e-4), (k / 30 - 14.5) * 2.1 * radius + random.uniform(-1e-4, 1e-4), 0.0);
        centres.push_back(place + Vec3(0.0, 0.0, scene::resting_height(hills, place, radius, 3e-5)));
    }
    const std::vector<Vec3> forces = forces_at(d, centres);
    const double strongest = largest_of(forces);
    for (const Vec3& f : forces) EXPECT_GT(f.norm(), 0.01 * strongest);
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        d.walls[0].mesh = scene::shuffled(hills, seed);
        const std::vector<Vec3> again = forces_at(d, centres);
        for (std::size_t k = 0; k < forces.size(); ++k) EXPECT_LT((again[k] - forces[k]).norm(), 1e-12 * strongest) << k;
    }
}

/// A spinning sphere that bounces about in a box.
std::vector<Vec3> rebounds(TriangleMesh mesh) {
    SimulationDefinition d = one_sphere(std::move(mesh), {0.8, 0.3, 0.0});
    d.gravity = {0.0, 0.0, -9.81};
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {4e-3, -3e-3, 5e-3};
    b.velocity = {1.3, -0.9, 0.4};
    b.spin = {100.0, -50.0, 30.0};
    s.add_bodies({&b, 1});
    std::vector<Vec3> path;
    for (int k = 0; k < 60; ++k) {
        s.advance(100);
        path.push_back(s.bodies().position[0]);
        path.push_back(1e-2 * s.bodies().velocity[0]);  // [cm/s]: of the size of the places
    }
    return path;
}

TEST(Wall, ABoxOf1200TrianglesIsTheBoxOf12) {
    // DEME #73: one sphere, one box, two triangulations, another rebound. Here about ten rebounds, edges and corners among them; each multiplies the rounding
    // (1e-17 m) by less than ten and adds that of the contact's normal, so 1e-12 m is rounding and nothing else.
    const Vec3 low(-0.01, -0.01, 0.0), high(0.01, 0.01, 0.02);
    const std::vector<Vec3> coarse = rebounds(scene::box(low, high));
    Vec3 reached = Vec3::Zero();
    for (const Vec3& p : coarse) reached = reached.cwiseMax(p.cwiseAbs());
    ASSERT_GT(reached.x(), 7.9e-3);
    ASSERT_GT(reached.y(), 7.9e-3);
    for (const int n : {2, 10, 40}) {
        const TriangleMesh fine = scene::fine_box(low, high, n);
        EXPECT_EQ(fine.faces.size(), static_cast<std::size_t>(12 * n * n));
        const std::vector<Vec3> path = rebounds(scene::shuffled(fine, 5));
        for (std::size_t k = 0; k < path.size(); ++k) EXPECT_LT((path[k] - coarse[k]).norm(), 1e-12) << n << " " << k;
    }
}

}  // namespace
}  // namespace pelletlab::solver
