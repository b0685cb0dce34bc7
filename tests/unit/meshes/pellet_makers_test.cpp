// Parametric pellets: closed, outward, of the closed-form volume, and with vertices on the true surface.
#include "meshes/pellet_makers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes/check.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

constexpr double pi = std::numbers::pi;

/// Closed, of the right volume when asked for, and inscribed otherwise: short of the true volume by less than `coefficient`/n². A circle's polygon alone lacks
/// (2π/n)²/6 = 6.6/n²; a dome adds its own arcs, and a bevel that narrows a body raises the share of its rim. `rate` is by how much the error falls when facets
/// double: 4 where all arcs get finer, less where a small rim keeps its four pieces.
template <class Body>
void expect_sound(const Body& body, double coefficient, double rate = 4.0) {
    const double exact = exact_volume(body);
    double previous = 0.0;
    for (const std::uint32_t facets : {24U, 48U, 96U}) {
        const TriangleMesh mesh = make_pellet(body, facets);
        const double error = 1.0 - volume_moments(mesh).volume / exact;
        EXPECT_GT(error, 0.0);
        EXPECT_LT(error, coefficient / (facets * facets)) << facets;
        if (previous != 0.0) {
            EXPECT_GT(previous / error, 0.8 * rate) << facets;
        }
        previous = error;
        const TriangleMesh scaled = make_pellet(body, facets, true);
        EXPECT_NEAR(volume_moments(scaled).volume / exact, 1.0, 1e-12);
        EXPECT_EQ(bounding_box(scaled).sizes().z(), bounding_box(mesh).sizes().z());
    }
    for (const std::uint32_t facets : {17U, 48U, 256U}) {
        const MeshReport report = check(make_pellet(body, facets));
        EXPECT_TRUE(report.is_closed_body()) << facets << '\n' << report.summary();
        EXPECT_EQ(report.shells, 1U);
        EXPECT_LT(report.faces, 20000U);
    }
}

TEST(PelletMakers, RoundedCylinder) {
    expect_sound(RoundedCylinder{3.12e-3, 2.96e-3, 0.2e-3}, 20.0, 2.0);
    expect_sound(RoundedCylinder{3.12e-3, 2.96e-3, 0.4e-3}, 20.0, 2.0);
    // The limits: no rounding is the plain cylinder, full rounding of an equal-sided one is a sphere.
    EXPECT_NEAR(exact_volume(RoundedCylinder{2e-3, 3e-3, 0.0}), pi * 3e-9, 1e-22);
    EXPECT_NEAR(exact_volume(RoundedCylinder{2e-3, 2e-3, 1e-3}), 4.0 / 3.0 * pi * 1e-9, 1e-22);
    EXPECT_TRUE(check(make_pellet(RoundedCylinder{2e-3, 3e-3, 0.0}, 32)).is_closed_body());
    const TriangleMesh ball = make_pellet(RoundedCylinder{2e-3, 2e-3, 1e-3}, 32);
    EXPECT_TRUE(check(ball).is_closed_body());
    for (const Vec3& v : ball.vertices) ASSERT_NEAR(v.norm(), 1e-3, 1e-17);
}

TEST(PelletMakers, RoundedRimLiesOnItsTorus) {
    const RoundedCylinder body{3.12e-3, 2.96e-3, 0.3e-3};
    std::size_t on_rim = 0;
    for (const Vec3& v : make_pellet(body, 48).vertices) {
        const double r = v.head<2>().norm(), over = r - (1.56e-3 - 0.3e-3), up = std::abs(v.z()) - (1.48e-3 - 0.3e-3);
        EXPECT_LE(r, 1.56e-3 * (1 + 1e-14));
        if (over > 1e-9 && up > 1e-9) {
            EXPECT_NEAR(std::hypot(over, up), 0.3e-3, 1e-17);
            ++on_rim;
        }
    }
    EXPECT_GE(on_rim, 2U * 48U * 3U);
}

TEST(PelletMakers, BevelledCylinder) {
    expect_sound(BevelledCylinder{3.12e-3, 2.96e-3, 0.2e-3, 0.3e-3}, 10.0);
    expect_sound(BevelledCylinder{3e-3, 1e-3, 0.8e-3, 0.5e-3}, 12.0);  // the bevels meet
}

TEST(PelletMakers, DomedCylinderAndCapsule) {
    expect_sound(DomedCylinder{3.12e-3, 2e-3, 0.48e-3}, 20.0);
    expect_sound(DomedCylinder{3e-3, 0.0, 0.4e-3}, 30.0);  // a lens
    expect_sound(Capsule{2e-3, 4e-3}, 30.0);
    const TriangleMesh capsule = make_pellet(Capsule{2e-3, 5e-3}, 32);
    for (const Vec3& v : capsule.vertices) {
        const Vec3 off(v.x(), v.y(), std::max(0.0, std::abs(v.z()) - 1.5e-3));
        ASSERT_NEAR(off.norm(), 1e-3, 1e-16);
    }
    EXPECT_NEAR(exact_volume(Capsule{2e-3, 2e-3}), 4.0 / 3.0 * pi * 1e-9, 1e-22);
    EXPECT_TRUE(check(make_pellet(Capsule{2e-3, 2e-3}, 32)).is_closed_body());
}

TEST(PelletMakers, RingHasABore) {
    const HollowCylinder body{5e-3, 2.5e-3, 5e-3};
    expect_sound(body, 7.0);
    const TriangleMesh mesh = make_pellet(body, 64, true);
    const MassProperties m = mass_properties(mesh, 1000.0);
    const double squares = 0.25 * (25e-6 + 6.25e-6);
    EXPECT_NEAR(m.principal_inertia.z() / (0.5 * m.mass * squares), 1.0, 1e-5);
    EXPECT_NEAR(m.principal_inertia.x() / (m.mass * (3 * squares + 25e-6) / 12.0), 1.0, 1e-5);
    double narrowest = 1.0;
    for (const Vec3& v : mesh.vertices) narrowest = std::min(narrowest, v.head<2>().norm());
    EXPECT_NEAR(narrowest, 1.25e-3, 0.003e-3);
}

TEST(PelletMakers, LobedExtrudates) {
    expect_sound(LobedExtrudate{3, 1e-3, 0.5e-3, 3e-3}, 20.0);
    expect_sound(LobedExtrudate{3, 1e-3, 0.3e-3, 3e-3}, 20.0);
    expect_sound(LobedExtrudate{3, 1e-3, 0.56e-3, 3e-3}, 30.0);  // the circles leave the middle open; it is filled
    expect_sound(LobedExtrudate{4, 1e-3, 0.6e-3, 3e-3}, 30.0);
    expect_sound(LobedExtrudate{2, 1e-3, 0.3e-3, 3e-3}, 20.0);
    // Two circles: the union's area is two circles less their lens 2 r² acos(c/r) − 2 c sqrt(r² − c²).
    const double r = 0.5, c = 0.3;
    EXPECT_NEAR(exact_volume(LobedExtrudate{2, 1e-3, 0.3e-3, 1e-3}) * 1e9, 2 * pi * r * r - (2 * r * r * std::acos(c / r) - 2 * c * std::sqrt(r * r - c * c)),
                1e-12);
    // A trilobe looks the same after a third of a turn: two equal moments.
    const MassProperties m = mass_properties(make_pellet(LobedExtrudate{}, 48, true), 1000.0);
    EXPECT_EQ(m.principal_inertia.x(), m.principal_inertia.y());
    EXPECT_TRUE(m.principal_axes.isApprox(Quat::Identity()));
}

TEST(PelletMakers, StretchedCylinderIsOval) {
    const TriangleMesh mesh = stretched(make_cylinder(3e-3, 3e-3, 48, true), {1.1, 1.0 / 1.1, 1.0});
    EXPECT_TRUE(check(mesh).is_closed_body());
    EXPECT_NEAR(check(mesh).volume / (0.25 * pi * 27e-9), 1.0, 1e-12);
    EXPECT_NEAR(bounding_box(mesh).sizes().x() / bounding_box(mesh).sizes().y(), 1.21, 1e-12);
}

TEST(PelletMakers, RefuseImpossibleShapes) {
    test::refusal([] { make_pellet(RoundedCylinder{3e-3, 2e-3, 1.1e-3}, 32); });
    test::refusal([] { make_pellet(RoundedCylinder{3e-3, 2e-3, -0.1e-3}, 32); });
    test::refusal([] { make_pellet(BevelledCylinder{3e-3, 2e-3, 1.5e-3, 0.1e-3}, 32); });
    test::refusal([] { make_pellet(BevelledCylinder{3e-3, 2e-3, 0.1e-3, 1.1e-3}, 32); });
    test::refusal([] { make_pellet(DomedCylinder{3e-3, -1e-3, 0.1e-3}, 32); });
    test::refusal([] { make_pellet(DomedCylinder{3e-3, 1e-3, 2e-3}, 32); });
    test::refusal([] { make_pellet(Capsule{3e-3, 2e-3}, 32); });
    test::refusal([] { make_pellet(HollowCylinder{3e-3, 3e-3, 1e-3}, 32); });
    test::refusal([] { make_pellet(LobedExtrudate{3, 1e-3, 0.6e-3, 1e-3}, 48); });
    test::refusal([] { make_pellet(LobedExtrudate{1, 1e-3, 0.3e-3, 1e-3}, 48); });
    test::refusal([] { make_pellet(LobedExtrudate{3, 1e-3, 0.3e-3, std::nan("")}, 48); });
    test::refusal([] { make_pellet(LobedExtrudate{}, 6); });
    test::refusal([] { stretched(make_sphere(1e-3, 1), {1, 0, 1}); });
}

}  // namespace
}  // namespace pelletlab::meshes
