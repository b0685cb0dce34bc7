// Closed forms of box, cylinder and sphere; the choice of principal axes.
#include "meshes/mass_properties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "meshes/makers.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

constexpr double pi = std::numbers::pi;

/// Inertia in the frame of the mesh.
Mat3 inertia_mesh(const MassProperties& m) {
    const Mat3 r = m.principal_axes.toRotationMatrix();
    return r * m.principal_inertia.asDiagonal() * r.transpose();
}

TEST(MassProperties, BoxIsExact) {
    const Vec3 lower(1e-3, 2e-3, 3e-3), size(1e-3, 2e-3, 4e-3);
    const MassProperties m = mass_properties(make_box(lower, lower + size), 1800.0);
    const double mass = 1800.0 * size.prod();
    EXPECT_NEAR(m.volume / size.prod(), 1.0, 1e-14);
    EXPECT_NEAR(m.mass / mass, 1.0, 1e-14);
    EXPECT_LT((m.centre_of_mass_mesh - lower - 0.5 * size).norm(), 1e-17);
    // Ascending: about the longest edge first, here z.
    const Vec3 about(size.y() * size.y() + size.z() * size.z(), size.x() * size.x() + size.z() * size.z(), size.x() * size.x() + size.y() * size.y());
    EXPECT_NEAR(m.principal_inertia.x() / (mass * about.z() / 12.0), 1.0, 1e-13);
    EXPECT_NEAR(m.principal_inertia.y() / (mass * about.y() / 12.0), 1.0, 1e-13);
    EXPECT_NEAR(m.principal_inertia.z() / (mass * about.x() / 12.0), 1.0, 1e-13);
    EXPECT_LT((m.principal_axes * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_LT((m.principal_axes * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_NEAR(m.principal_axes.toRotationMatrix().determinant(), 1.0, 1e-12);
}

TEST(MassProperties, FarFromTheOriginLosesNoDigits) {
    const MassProperties here = mass_properties(make_box({0, 0, 0}, {1e-3, 2e-3, 4e-3}), 1000.0);
    const MassProperties there = mass_properties(test::moved(make_box({0, 0, 0}, {1e-3, 2e-3, 4e-3}), {1.0, -2.0, 0.5}), 1000.0);
    // The vertices themselves are rounded to 2e-16 m there, 2e-13 of the smallest edge.
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(there.principal_inertia[k] / here.principal_inertia[k], 1.0, 2e-12);
}

TEST(MassProperties, CylinderWithExactVolumeConverges) {
    const double d = 3.12e-3, h = 2.96e-3, volume = 0.25 * pi * d * d * h;
    const MassProperties m = mass_properties(make_cylinder(d, h, 256, true), 1800.0);
    EXPECT_NEAR(m.volume / volume, 1.0, 1e-12);
    // A polygon of equal area has a polar moment larger by (2π/n)⁴/180 · … < 2e-9 for n = 256.
    EXPECT_NEAR(m.principal_inertia.z() / (m.mass * d * d / 8.0), 1.0, 1e-8);
    EXPECT_NEAR(m.principal_inertia.x() / (m.mass * (0.75 * d * d + h * h) / 12.0), 1.0, 1e-8);
    EXPECT_EQ(m.principal_inertia.x(), m.principal_inertia.y());
    EXPECT_TRUE(m.principal_axes.isApprox(Quat::Identity()));
}

TEST(MassProperties, PolygonOfACylinderIsExact) {
    // Regular prism of n sides and circumradius r: area n/2 r² sin(2π/n), polar moment A r² (2 + cos(2π/n)) / 6.
    const double d = 3e-3, h = 5e-3, r = 0.5 * d;
    const std::uint32_t n = 7;
    const MassProperties m = mass_properties(make_cylinder(d, h, n), 1.0);
    const double area = 0.5 * n * r * r * std::sin(2 * pi / n);
    EXPECT_NEAR(m.volume / (area * h), 1.0, 1e-13);
    EXPECT_NEAR(m.principal_inertia.z() / (area * h * r * r * (2 + std::cos(2 * pi / n)) / 6.0), 1.0, 1e-12);
}

TEST(MassProperties, SphereKeepsTheMeshAxes) {
    const double d = 2e-3;
    const MassProperties m = mass_properties(make_sphere(d, 5), 1000.0);
    // 20480 facets inside the sphere: the edge is about d/50, the sagitta 1e-4 d, the volume lower by 3e-4 or so.
    EXPECT_NEAR(m.volume / (pi / 6 * d * d * d), 1.0, 6e-4);
    EXPECT_LT(m.volume, pi / 6 * d * d * d);
    EXPECT_NEAR(m.principal_inertia.x() / (m.mass * d * d / 10.0), 1.0, 6e-4);
    EXPECT_EQ(m.principal_axes.w(), 1.0);
}

TEST(MassProperties, AxisOfSymmetryBecomesBodyZWhateverItsMoment) {
    const Quat turn = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    for (const double height : {1e-3, 2.96e-3, 9e-3}) {  // flat: largest moment; long: smallest
        const TriangleMesh mesh = transformed(make_cylinder(3.12e-3, height, 64, true), {Vec3(1e-3, 0, 0), turn});
        const MassProperties m = mass_properties(mesh, 1000.0);
        const Vec3 axis = m.principal_axes * Vec3::UnitZ();
        EXPECT_NEAR(std::abs(axis.dot(turn * Vec3::UnitZ())), 1.0, 1e-9) << height;
        EXPECT_EQ(m.principal_inertia.x(), m.principal_inertia.y());
        EXPECT_NEAR(m.principal_inertia.z() / (m.mass * 3.12e-3 * 3.12e-3 / 8.0), 1.0, 1e-5);
    }
}

TEST(MassProperties, PrincipalFrameRebuildsAnyInertia) {
    for (std::uint64_t s = 0; s < 50; ++s) {
        RandomStream random(3, s);
        const Vec3 size(random.uniform(1, 2), random.uniform(2.1, 3), random.uniform(3.1, 4));
        const Pose pose{Vec3(random.normal(), random.normal(), random.normal()), random.rotation()};
        const TriangleMesh box = make_box(-0.5e-3 * size, 0.5e-3 * size);
        const MassProperties straight = mass_properties(box, 1000.0), turned = mass_properties(transformed(box, pose), 1000.0);
        EXPECT_LT((turned.principal_inertia - straight.principal_inertia).norm() / straight.principal_inertia.norm(), 1e-11);
        const Mat3 r = pose.orientation.toRotationMatrix();
        EXPECT_LT((inertia_mesh(turned) - r * inertia_mesh(straight) * r.transpose()).norm() / straight.principal_inertia.norm(), 1e-11);
        EXPECT_NEAR(turned.principal_axes.toRotationMatrix().determinant(), 1.0, 1e-12);
    }
}

TEST(MassProperties, CavityIsSubtracted) {
    const TriangleMesh hollow =
        test::joined(make_box({-2e-3, -2e-3, -2e-3}, {2e-3, 2e-3, 2e-3}), test::flipped(make_box({-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3})));
    const MassProperties m = mass_properties(hollow, 1.0);
    EXPECT_NEAR(m.volume, 56e-9, 1e-20);
    EXPECT_NEAR(m.principal_inertia.x() / ((64e-9 * 16e-6 - 8e-9 * 4e-6) / 6.0), 1.0, 1e-13);
}

TEST(MassProperties, RefusesWhatHasNoMass) {
    const TriangleMesh box = make_box({0, 0, 0}, {1e-3, 1e-3, 1e-3});
    EXPECT_NE(test::refusal([&] { mass_properties(test::flipped(box), 1000.0); }).find("inside-out"), std::string::npos);
    EXPECT_NE(test::refusal([&] { mass_properties(box, 0.0); }).find("density"), std::string::npos);
    EXPECT_NE(test::refusal([&] { mass_properties(box, std::nan("")); }).find("density"), std::string::npos);
    test::refusal([&] { mass_properties({}, 1000.0); });
    TriangleMesh flat = box;
    for (Vec3& v : flat.vertices) v.z() = 0.0;
    EXPECT_NE(test::refusal([&] { mass_properties(flat, 1000.0); }).find("no volume"), std::string::npos);
}

}  // namespace
}  // namespace pelletlab::meshes
