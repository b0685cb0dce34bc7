// Parametric bodies are closed and of the right size; walls face the pellets and touch the circle of their diameter.
#include "meshes/makers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "meshes/check.hpp"
#include "meshes/detail/rings.hpp"
#include "meshes/detail/weld.hpp"
#include "meshes/mass_properties.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

Vec3 normal(const TriangleMesh& mesh, std::size_t f) {
    return (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0)).normalized();
}

double smallest_angle(const TriangleMesh& mesh, std::size_t f) {
    double smallest = 10.0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 p = mesh.corner(f, k), u = mesh.corner(f, (k + 1) % 3) - p, v = mesh.corner(f, (k + 2) % 3) - p;
        smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
    return smallest * 180.0 / std::numbers::pi;
}

TEST(Makers, CylinderIsClosedForAnyNumberOfFacets) {
    for (const std::uint32_t facets : {3U, 4U, 5U, 7U, 12U, 31U, 64U, 97U, 256U, 500U})
        for (const double height : {0.3e-3, 2.96e-3, 12e-3}) {
            const MeshReport report = check(make_cylinder(3.12e-3, height, facets));
            EXPECT_TRUE(report.is_closed_body()) << facets << ' ' << height << '\n' << report.summary();
            EXPECT_EQ(report.shells, 1U);
            EXPECT_NEAR(report.volume / (0.5 * facets * 1.56e-3 * 1.56e-3 * std::sin(2 * std::numbers::pi / facets) * height), 1.0, 1e-12);
            EXPECT_NEAR(report.extent.z(), height, 1e-18);
        }
}

TEST(Makers, CylinderVerticesLieOnTheCircleUnlessItsVolumeShallBeExact) {
    const double r = 1.56e-3;
    const auto largest_radius = [](const TriangleMesh& mesh) {
        double radius = 0.0;
        for (const Vec3& v : mesh.vertices) radius = std::max(radius, v.head<2>().norm());
        return radius;
    };
    EXPECT_NEAR(largest_radius(make_cylinder(2 * r, 3e-3, 48)) / r, 1.0, 1e-15);
    const double exact = largest_radius(make_cylinder(2 * r, 3e-3, 48, true)) / r;
    const double step = 2 * std::numbers::pi / 48;
    EXPECT_NEAR(exact, std::sqrt(step / std::sin(step)), 1e-14);
}

TEST(Makers, CylinderFacesAreWellShaped) {
    const TriangleMesh mesh = make_cylinder(3.12e-3, 2.96e-3, 48, true);
    double worst = 90.0, mean = 0.0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        worst = std::min(worst, smallest_angle(mesh, f));
        mean += smallest_angle(mesh, f) / static_cast<double>(mesh.faces.size());
    }
    EXPECT_GT(worst, 20.0);
    EXPECT_GT(mean, 40.0);  // 60 is an equilateral triangle, 45 half a square
    EXPECT_LT(make_cylinder(3.12e-3, 2.96e-3, 256).faces.size(), 6000U);
}

TEST(Makers, TubeShellTouchesTheCircleFromOutsideAndFacesInward) {
    const double d = 52e-3;
    for (const std::uint32_t facets : {3U, 24U, 96U}) {
        const TriangleMesh shell = make_tube_shell(d, -1e-3, 0.3, facets);
        EXPECT_EQ(shell.faces.size(), 2U * facets);
        for (std::size_t f = 0; f < shell.faces.size(); ++f) {
            const Vec3 n = normal(shell, f);
            EXPECT_NEAR(n.z(), 0.0, 1e-14);
            EXPECT_NEAR(-n.dot(shell.corner(f, 0)), 0.5 * d, 1e-16 + 1e-14 * d);  // inradius of the plane, and its sign: towards the axis
        }
        const Box box = bounding_box(shell);
        EXPECT_EQ(box.min().z(), -1e-3);
        EXPECT_EQ(box.max().z(), 0.3);
    }
}

TEST(Makers, TubeAndDiscsWeldIntoAClosedVessel) {
    const double d = 52e-3;
    for (const std::uint32_t facets : {5U, 96U, 120U}) {
        const TriangleMesh vessel =
            test::joined(make_tube_shell(d, 0.0, 0.1, facets), test::joined(make_disc(0.5 * d, 0.0, true, facets), make_disc(0.5 * d, 0.1, false, facets)));
        const MeshReport report = check(detail::weld(vessel));
        EXPECT_EQ(report.boundary_edges, 0U);
        EXPECT_EQ(report.inconsistent_edges, 0U);
        EXPECT_EQ(report.self_intersections, 0U);
        EXPECT_EQ(report.shells, 1U);
        // All normals inward: the signed volume is minus that of the circumscribed prism.
        EXPECT_NEAR(report.volume / (-0.25 * facets * d * d * std::tan(std::numbers::pi / facets) * 0.1), 1.0, 1e-12);
    }
}

TEST(Makers, DrumPartsWeldIntoAClosedVesselAboutY) {
    const double d = 80e-3, length = 20e-3;
    const std::uint32_t facets = 120;
    const TriangleMesh shell = make_drum_shell(d, length, facets);
    for (std::size_t f = 0; f < shell.faces.size(); ++f) {
        const Vec3 n = normal(shell, f);
        EXPECT_NEAR(n.y(), 0.0, 1e-14);
        EXPECT_NEAR(-n.dot(shell.corner(f, 0)), 0.5 * d, 1e-15);
    }
    const TriangleMesh left = make_drum_end(d, -0.5 * length, true, facets), right = make_drum_end(d, 0.5 * length, false, facets);
    EXPECT_LT((normal(left, 0) - Vec3::UnitY()).norm(), 1e-14);
    EXPECT_LT((normal(right, 0) + Vec3::UnitY()).norm(), 1e-14);
    const MeshReport report = check(detail::weld(test::joined(shell, test::joined(left, right))));
    EXPECT_EQ(report.boundary_edges + report.inconsistent_edges + report.self_intersections, 0U);
    EXPECT_LT(report.volume, 0.0);
    EXPECT_NEAR(report.extent.y(), length, 1e-17);
}

TEST(Makers, BoxAndSphereAreClosed) {
    const MeshReport box = check(make_box({-1e-3, 0, 2e-3}, {1e-3, 3e-3, 3e-3}));
    EXPECT_TRUE(box.is_closed_body()) << box.summary();
    EXPECT_NEAR(box.volume, 6e-9, 1e-22);
    EXPECT_NEAR(box.area, 22e-6, 1e-19);
    for (std::uint32_t level = 0; level < 5; ++level) {
        const TriangleMesh sphere = make_sphere(2e-3, level);
        EXPECT_EQ(sphere.faces.size(), 20U << (2 * level));
        EXPECT_TRUE(check(sphere).is_closed_body()) << level;
        for (const Vec3& v : sphere.vertices) ASSERT_NEAR(v.norm(), 1e-3, 1e-18);
    }
}

TEST(Makers, CirclesOfFourNPointsAreSymmetricToTheLastBit) {
    const std::vector<Vec3> circle = detail::unit_circle(96);
    for (std::size_t k = 0; k < 24; ++k) {
        EXPECT_EQ(circle[k].x(), circle[k + 24].y());
        EXPECT_EQ(circle[k].x(), -circle[k + 48].x());
        EXPECT_EQ(circle[k].y(), -circle[k + 48].y());
    }
}

TEST(Makers, RefuseImpossibleSizes) {
    EXPECT_NE(test::refusal([] { make_cylinder(-1e-3, 1e-3, 32); }).find("diameter"), std::string::npos);
    EXPECT_NE(test::refusal([] { make_cylinder(1e-3, std::nan(""), 32); }).find("height"), std::string::npos);
    EXPECT_NE(test::refusal([] { make_cylinder(1e-3, 1e-3, 2); }).find("facets"), std::string::npos);
    test::refusal([] { make_tube_shell(52e-3, 0.1, 0.1, 96); });
    test::refusal([] { make_disc(0.0, 0.0, true, 96); });
    test::refusal([] { make_drum_shell(80e-3, 0.0, 96); });
    test::refusal([] { make_box({0, 0, 0}, {1, -1, 1}); });
    test::refusal([] { make_sphere(1e-3, 99); });
}

TEST(WallMakers, FunnelTouchesItsThreeCirclesAndFacesInward) {
    const double cone = funnel_cone_height(0.03, 0.1, std::numbers::pi / 6.0);
    EXPECT_NEAR(cone, 0.035 * std::sqrt(3.0), 1e-15);  // 35 mm of radius at 30°
    const TriangleMesh mesh = make_funnel(0.03, 0.1, std::numbers::pi / 6.0, 0.02, 0.2, 64);
    const Box box = bounding_box(mesh);
    EXPECT_DOUBLE_EQ(box.min().z(), 0.02);
    EXPECT_DOUBLE_EQ(box.max().z(), 0.2);
    double area = 0.0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2), middle = (a + b + c) / 3.0, normal = (b - a).cross(c - a);
        area += 0.5 * normal.norm();
        EXPECT_LT(normal.dot(Vec3(middle.x(), middle.y(), 0.0)), 0.0) << "towards the axis";
        if (middle.z() > 0.02 + cone) continue;
        EXPECT_NEAR(std::atan2(normal.z(), -normal.dot(Vec3(middle.x(), middle.y(), 0.0).normalized())), std::numbers::pi / 6.0, 0.01) << "the half angle";
    }
    // Frustum π (r₁ + r₂) · slant and cylinder π D h; a polygon circumscribed about n facets is larger by (n/π) tan(π/n): 0.08 % at 64.
    const double slant = cone / std::cos(std::numbers::pi / 6.0);
    const double exact = std::numbers::pi * (0.015 + 0.05) * slant + std::numbers::pi * 0.1 * (0.18 - cone);
    EXPECT_NEAR(area, exact, 0.002 * exact);
    EXPECT_THROW(make_funnel(0.1, 0.03, 0.5, 0.0, 0.2, 64), Error) << "the outlet is wider than the top";
    EXPECT_THROW(make_funnel(0.03, 0.1, 0.5, 0.0, 0.01, 64), Error) << "lower than its cone";
}

TEST(WallMakers, BaffleStandsAtItsAngle) {
    for (const double angle : {0.0, 0.5, std::numbers::pi}) {
        const TriangleMesh mesh = make_baffle(0.254, 0.152, 0.051, 0.003, angle);
        EXPECT_NEAR(mass_properties(mesh, 1000.0).volume, 0.152 * 0.051 * 0.003, 1e-12);
        // Down at 0, then as a turn about +y carries it: (−sin φ, 0, −cos φ).
        const Vec3 centre = mass_properties(mesh, 1000.0).centre_of_mass_mesh;
        const Vec3 expected = (0.127 - 0.0255) * Vec3(-std::sin(angle), 0.0, -std::cos(angle));
        EXPECT_LT((centre - expected).norm(), 1e-12) << angle;
    }
    EXPECT_THROW(make_baffle(0.1, 0.1, 0.06, 0.003, 0.0), Error) << "beyond the axis";
}

}  // namespace
}  // namespace pelletlab::meshes
