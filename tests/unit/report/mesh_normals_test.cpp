#include <gtest/gtest.h>

#include "report/detail/prepared_scene.hpp"
#include "report/detail/sphere_mesh.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

TEST(MeshNormals, ABoxKeepsItsSharpEdges) {
    const TriangleMesh mesh = testing::box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
    const auto normals = detail::corner_normals(mesh, 0.6);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 n = (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0)).normalized();
        for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((normals[f][k].cast<double>() - n).norm(), 1e-6);
    }
    EXPECT_EQ(detail::feature_edges(mesh, 0.6).size(), 12u);
}

TEST(MeshNormals, ACylinderIsSmoothRoundAndSharpAtTheRims) {
    const TriangleMesh mesh = testing::cylinder(2.0, 3.0, 32);
    const auto normals = detail::corner_normals(mesh, 0.6);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = mesh.corner(f, k), n = normals[f][static_cast<std::size_t>(k)].cast<double>();
            const bool cap = mesh.faces[f][0] < 2;
            const Vec3 expected = cap ? Vec3(0.0, 0.0, p.z() > 0.0 ? 1.0 : -1.0) : Vec3(Vec3(p.x(), p.y(), 0.0).normalized());
            // Angle weights differ between the two diagonals at a vertex: off the radius by less than a facet's angle, 2π/32.
            EXPECT_LT((n - expected).norm(), cap ? 1e-6 : 0.1);
        }
    EXPECT_EQ(detail::feature_edges(mesh, 0.6).size(), 64u);
}

TEST(MeshNormals, OpenBordersAreEdges) {
    EXPECT_EQ(detail::feature_edges(testing::tube(1.0, 0.0, 1.0, 24), 0.6).size(), 48u);
}

TEST(SphereMesh, LiesOnTheSphereAndFacesOutward) {
    for (int s = 0; s < 4; ++s) {
        const TriangleMesh mesh = detail::unit_sphere(s);
        EXPECT_EQ(mesh.vertices.size(), 10u * (std::size_t{1} << (2 * s)) + 2u);
        EXPECT_EQ(mesh.faces.size(), 20u * (std::size_t{1} << (2 * s)));
        double volume = 0.0;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) volume += mesh.corner(f, 0).dot(mesh.corner(f, 1).cross(mesh.corner(f, 2))) / 6.0;
        EXPECT_GT(volume, 2.5);
        EXPECT_LT(volume, 4.0 / 3.0 * std::numbers::pi);
        for (const Vec3& vertex : mesh.vertices) EXPECT_NEAR(vertex.norm(), 1.0, 1e-12);
    }
}

TEST(SphereMesh, WhatCanShowIsNearTheUnionsSurface) {
    const std::vector<Sphere> spheres = {{{0.0, 0.0, 0.0}, 1.0}, {{1.0, 0.0, 0.0}, 0.8}, {{0.1, 0.0, 0.0}, 0.3}};  // the last one is hidden
    const TriangleMesh all = sphere_surfaces(spheres);
    const detail::ShowingSurface surface = detail::showing_surface(spheres);
    const std::size_t each = all.vertices.size() / spheres.size();
    const double edge = detail::relative_edge(spheres.size());
    std::vector<bool> kept(all.vertices.size(), false);
    for (std::size_t k = 0; k < surface.mesh.vertices.size(); ++k) {
        const Sphere& own = spheres[surface.sphere[k]];
        kept[surface.number[k]] = true;
        ASSERT_EQ(surface.number[k] / each, surface.sphere[k]);
        ASSERT_LT((surface.mesh.vertices[k] - all.vertices[surface.number[k]]).norm(), 1e-12);
        ASSERT_LT((surface.mesh.vertices[k] - own.centre - own.radius * surface.normals[k]).norm(), 1e-12);
    }
    std::size_t showing = 0;
    for (std::size_t i = 0; i < all.vertices.size(); ++i) {
        double deepest = -1.0;
        for (std::size_t s = 0; s < spheres.size(); ++s)
            if (s != i / each) deepest = std::max(deepest, spheres[s].radius - (all.vertices[i] - spheres[s].centre).norm());
        ASSERT_EQ(kept[i], deepest <= edge * spheres[i / each].radius) << i;
        showing += deepest < 0.0 ? 1 : 0;
    }
    EXPECT_GT(showing, each);
    EXPECT_LT(surface.mesh.vertices.size(), 2 * each);
    for (const std::uint32_t owner : surface.sphere) EXPECT_NE(owner, 2u);
}

TEST(SphereMesh, LongestEdgeIsAsStated) {
    for (const std::size_t count : {1u, 200u, 500u}) {
        const std::vector<Sphere> spheres(count, Sphere{{0.0, 0.0, 0.0}, 1.0});
        const TriangleMesh mesh = sphere_surfaces(spheres);
        double longest = 0.0;
        for (std::size_t f = 0; f < mesh.faces.size() / count; ++f) longest = std::max(longest, (mesh.corner(f, 0) - mesh.corner(f, 1)).norm());
        EXPECT_LE(longest, detail::relative_edge(count));
    }
}

}  // namespace
}  // namespace pelletlab::report
