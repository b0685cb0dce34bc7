#include "shapegen/surface_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analytic_cylinder.hpp"
#include "meshes/makers.hpp"
#include "shapegen/detail/smooth_patches.hpp"
#include "shapegen/hand_made.hpp"

namespace pelletlab::shapegen {
namespace {

// clump_metrics.py on shape4_layout_A.csv, which measures the same on regular grids and on 2 × 1440 points of the rim; band 0.25 mm, press 0.01 mm.
TEST(SurfaceReport, Shape4AgreesWithTheIndependentScript) {
    const AnalyticCylinder cylinder(3.12e-3, 2.96e-3);
    const TriangleMesh body = meshes::make_cylinder(3.12e-3, 2.96e-3, 256);
    SurfaceReportSettings settings;
    settings.edge_band = 0.25 / 2.96;
    settings.press = 0.01e-3;
    const SurfaceReport report = measure_surface(hand_made_shape(4), body, cylinder, settings);
    ASSERT_EQ(report.patches.size(), 3u);
    EXPECT_NEAR(report.flat_sq, 0.0363e-3, 0.0008e-3);  // 2 %: random points against a grid
    EXPECT_NEAR(report.flat_sz, 0.180e-3, 0.004e-3);
    EXPECT_NEAR(report.curved_sq, 0.0278e-3, 0.0006e-3);
    EXPECT_NEAR(report.curved_sz, 0.129e-3, 0.006e-3);  // extremes: our random points find deeper pits than the grid
    const double degree = std::numbers::pi / 180.0;
    EXPECT_NEAR(report.normal_mean / degree, 20.8, 0.2);
    EXPECT_NEAR(report.normal_rms / degree, 23.9, 0.2);
    EXPECT_NEAR(report.edge_radius_mean, 0.433e-3, 0.003e-3);
    EXPECT_NEAR(report.edge_radius_max, 0.612e-3, 0.006e-3);  // a cusp between two spheres, seen along the bisector of a facet
    EXPECT_NEAR(report.support_mean, -0.1060e-3, 0.0005e-3);
    EXPECT_NEAR(report.support_rms, 0.1139e-3, 0.0005e-3);
    EXPECT_NEAR(report.support_max, 0.162e-3, 0.002e-3);
    EXPECT_EQ(report.contacts_on_flat, 33.0);
    EXPECT_EQ(report.most_on_flat, 33u);
    EXPECT_NEAR(report.sum_volume / report.mesh_volume, 4.25, 0.01);
    EXPECT_NEAR(report.smallest_radius, 0.35e-3, 1e-12);
    EXPECT_NEAR(report.largest_radius, 0.765e-3, 1e-12);
    EXPECT_EQ(report.components, 1u);
    EXPECT_NEAR(report.sealed_volume / report.mesh_volume, 0.0009, 0.0005);
}

TEST(SurfaceReport, OneBallInABox) {
    const TriangleMesh box = meshes::make_box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    const auto exact = meshes::exact_signed_distance(box);
    const SurfaceReport report = measure_surface(std::vector<Sphere>{{Vec3::Zero(), 1.0}}, box, *exact);
    EXPECT_EQ(report.patches.size(), 6u);
    EXPECT_EQ(report.contacts_on_flat, 1.0);
    EXPECT_EQ(report.most_any_way, 1u);
    // In the middle of an edge the way along the bisector is √2 − 1, which is the rounded edge of radius 1; towards the corners it grows.
    EXPECT_GT(report.edge_radius_mean, 1.0);
    EXPECT_NEAR(report.support_max, std::sqrt(3.0) - 1.0, 2e-2);  // a corner
    EXPECT_NEAR(report.union_volume, 4.0 / 3.0 * std::numbers::pi, 1e-9);
}

TEST(SurfaceReport, PiecesAreCounted) {
    const TriangleMesh box = meshes::make_box(Vec3(-2, -1, -1), Vec3(2, 1, 1));
    const auto exact = meshes::exact_signed_distance(box);
    EXPECT_EQ(measure_surface(std::vector<Sphere>{{{-1, 0, 0}, 0.6}, {{1, 0, 0}, 0.6}}, box, *exact).components, 2u);
    EXPECT_EQ(measure_surface(std::vector<Sphere>{{{-0.5, 0, 0}, 0.6}, {{0.5, 0, 0}, 0.6}}, box, *exact).components, 1u);
}

TEST(SmoothPatches, ConvexAndConcaveEdges) {
    // An L: six vertices in the plane, extruded; one of its long edges is concave.
    const double xy[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    TriangleMesh mesh;
    for (const double z : {0.0, 1.0})
        for (const auto& p : xy) mesh.vertices.push_back({p[0], p[1], z});
    const std::uint32_t cap[4][3] = {{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}};
    for (const auto& t : cap) {
        mesh.faces.push_back({t[0], t[2], t[1]});
        mesh.faces.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
    }
    for (std::uint32_t k = 0; k < 6; ++k) {
        const std::uint32_t next = (k + 1) % 6;
        mesh.faces.push_back({k, next, next + 6});
        mesh.faces.push_back({k, next + 6, k + 6});
    }
    const detail::SmoothPatches patches = detail::smooth_patches(mesh, 0.5);
    EXPECT_EQ(patches.count, 8u);
    std::size_t concave = 0;
    for (const detail::SharpEdge& edge : patches.edges) {
        if (edge.inner_angle < std::numbers::pi) {
            EXPECT_NEAR(edge.inner_angle, 0.5 * std::numbers::pi, 1e-12);
            continue;
        }
        ++concave;
        EXPECT_NEAR(edge.inner_angle, 1.5 * std::numbers::pi, 1e-12);
        EXPECT_NEAR(edge.a.x(), 1.0, 1e-12);
        EXPECT_NEAR(edge.a.y(), 1.0, 1e-12);
    }
    EXPECT_EQ(concave, 1u);
    EXPECT_EQ(patches.edges.size(), 18u);
}

}  // namespace
}  // namespace pelletlab::shapegen
