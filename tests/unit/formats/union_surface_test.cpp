// The STL of the union: closed, outward, and as accurate as docs/clump-formats.md says.
#include "shapegen/formats/union_surface.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <numbers>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "test_clump.hpp"

namespace pelletlab::shapegen::formats {
namespace {

constexpr double pi = std::numbers::pi;

/// Union of two unit spheres a distance d < 2 apart: 8π/3 minus the lens π (4 + d)(2 − d)² / 12.
double two_spheres(double d) {
    return 8.0 * pi / 3.0 - pi * (4.0 + d) * (2.0 - d) * (2.0 - d) / 12.0;
}

/// Directed edges that lack their opposite or occur twice.
std::size_t open_edges(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
    for (const Triangle& f : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) ++count[{f[k], f[(k + 1) % 3]}];
    std::size_t open = 0;
    for (const auto& [edge, n] : count) {
        const auto opposite = count.find({edge.second, edge.first});
        if (n != 1 || opposite == count.end() || opposite->second != 1) ++open;
    }
    return open;
}

TEST(UnionSurface, OneSphere) {
    const std::vector<Sphere> spheres{{Vec3(0.1, -0.2, 0.3), 1.0}};
    const UnionSurface surface = union_surface(spheres);
    EXPECT_EQ(open_edges(surface.mesh), 0U);
    // Vertices on the sphere, chords inside: relative loss of volume about (h/r)²/4 … (h/r)²/2 with h = r/64.
    EXPECT_LT(surface.volume, 4.0 * pi / 3.0);
    EXPECT_NEAR(surface.volume / (4.0 * pi / 3.0), 1.0, 2e-4);
    EXPECT_LT(surface.vertex_distance, 1e-9 * surface.voxel * 1.01);
    EXPECT_LT(surface.centre_distance, surface.voxel * surface.voxel / 2.0);  // sagitta c²/2r of a triangle of circumradius c ≤ h
}

TEST(UnionSurface, TwoSpheresAgainstClosedForm) {
    const double d = 1.2;
    const std::vector<Sphere> spheres{{Vec3::Zero(), 1.0}, {Vec3(0.36, 0.48, 1.0392304845413265), 1.0}};
    ASSERT_NEAR((spheres[0].centre - spheres[1].centre).norm(), d, 1e-12);
    double last = 1.0;
    for (const double h : {0.1, 0.05, 0.025}) {
        const UnionSurface surface = union_surface(spheres, h);
        const double error = std::abs(surface.volume / two_spheres(d) - 1.0);
        EXPECT_EQ(open_edges(surface.mesh), 0U);
        EXPECT_LT(error, 0.5 * h * h) << h;  // second order
        EXPECT_LT(error, last);
        EXPECT_LT(surface.centre_distance, 0.35 * h) << h;  // groove between the spheres
        last = error;
    }
}

TEST(UnionSurface, RandomClumpIsClosedAndOnTheUnion) {
    for (const std::size_t count : {3U, 24U, 200U}) {
        const ClumpTemplate clump = test_clump(count);
        const UnionSurface surface = union_surface(clump.rigid.spheres);
        EXPECT_EQ(open_edges(surface.mesh), 0U) << count;
        EXPECT_LT(surface.vertex_distance, 1e-6 * clump.rigid.bounding_radius) << count;
        EXPECT_LT(surface.centre_distance, 0.87 * surface.voxel) << count;  // half the diagonal of a cell, where three spheres meet
    }
}

TEST(UnionSurface, SeparateAndTouchingSpheres) {
    const std::vector<Sphere> apart{{Vec3::Zero(), 1.0}, {Vec3(3.0, 0.0, 0.0), 0.5}};
    const UnionSurface two = union_surface(apart, 0.05);
    EXPECT_EQ(open_edges(two.mesh), 0U);
    EXPECT_NEAR(two.volume / (4.0 * pi / 3.0 * 1.125), 1.0, 2e-3);
    const std::vector<Sphere> touching{{Vec3::Zero(), 1.0}, {Vec3(2.0, 0.0, 0.0), 1.0}};
    EXPECT_EQ(open_edges(union_surface(touching, 0.05).mesh), 0U);
}

TEST(UnionSurface, SmallSphereIsNotLost) {
    const std::vector<Sphere> spheres{{Vec3::Zero(), 1.0}, {Vec3(1.02, 0.0, 0.0), 0.04}};
    const UnionSurface surface = union_surface(spheres);
    double farthest = 0.0;
    for (const Vec3& v : surface.mesh.vertices) farthest = std::max(farthest, v.x());
    EXPECT_NEAR(farthest, 1.06, 0.01);
    EXPECT_LE(surface.voxel, 0.04 / 3.0);
}

TEST(UnionSurface, SameMeshForAnyNumberOfThreads) {
    const ClumpTemplate clump = test_clump(24);
    set_thread_count(1);
    const UnionSurface one = union_surface(clump.rigid.spheres);
    set_thread_count(3);
    const UnionSurface three = union_surface(clump.rigid.spheres);
    set_thread_count(0);
    EXPECT_EQ(one.mesh.faces, three.mesh.faces);
    ASSERT_EQ(one.mesh.vertices.size(), three.mesh.vertices.size());
    for (std::size_t v = 0; v < one.mesh.vertices.size(); ++v) ASSERT_EQ(one.mesh.vertices[v], three.mesh.vertices[v]);
}

TEST(UnionSurface, RefusesBadCells) {
    const std::vector<Sphere> spheres{{Vec3::Zero(), 1.0}};
    EXPECT_THROW(union_surface(spheres, -1.0), Error);
    EXPECT_THROW(union_surface(spheres, 0.6), Error);
    EXPECT_THROW(union_surface(spheres, 1e-4), Error);
    EXPECT_THROW(union_surface({}, 0.0), Error);
}

TEST(Stl, HoldsTheSurfaceInItsUnit) {
    const ClumpTemplate clump = test_clump(24);
    const std::string bytes = find("stl").write(clump, {})[0].content;
    ASSERT_GT(bytes.size(), 84U);
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    ASSERT_EQ(bytes.size(), 84 + 50 * static_cast<std::size_t>(count));
    EXPECT_NE(bytes.rfind("solid", 0), 0U);  // readers take that for ASCII
    EXPECT_EQ(bytes.rfind("PelletLab union of spheres, unit mm, test_pellet_1 ", 0), 0U);
    // Welded by equal coordinates, as readers do it, the surface is still closed; the volume is that of the double-precision mesh.
    TriangleMesh mesh;
    std::map<std::array<float, 3>, std::uint32_t> index;
    for (std::uint32_t f = 0; f < count; ++f) {
        float v[12];
        std::memcpy(v, bytes.data() + 84 + 50 * static_cast<std::size_t>(f), sizeof v);
        Triangle face{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::array<float, 3> corner{v[3 + 3 * k], v[4 + 3 * k], v[5 + 3 * k]};
            const auto [at, is_new] = index.try_emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) mesh.vertices.emplace_back(corner[0], corner[1], corner[2]);
            face[k] = at->second;
        }
        const Vec3 normal = (mesh.vertices[face[1]] - mesh.vertices[face[0]]).cross(mesh.vertices[face[2]] - mesh.vertices[face[0]]);
        EXPECT_TRUE(normal.norm() < 1e-8 || normal.normalized().dot(Vec3(v[0], v[1], v[2])) > 0.9);
        mesh.faces.push_back(face);
    }
    EXPECT_EQ(open_edges(mesh), 0U);
    double volume = 0.0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) volume += mesh.corner(f, 0).dot(mesh.corner(f, 1).cross(mesh.corner(f, 2))) / 6.0;
    EXPECT_NEAR(volume * 1e-9 / union_surface(clump.rigid.spheres).volume, 1.0, 1e-6);
}

}  // namespace
}  // namespace pelletlab::shapegen::formats
