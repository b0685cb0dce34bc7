#include "shapegen/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analytic_cylinder.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "meshes/makers.hpp"
#include "shapegen/detail/column_overlap.hpp"
#include "shapegen/detail/outer_surface.hpp"
#include "shapegen/detail/surface_samples.hpp"
#include "shapegen/detail/union_distance.hpp"
#include "shapegen/hand_made.hpp"

namespace pelletlab::shapegen {
namespace {

constexpr double pi = std::numbers::pi;

// clump_metrics.py on shape4_layout_A.csv (it prints three or four digits); its own sampling errors: 60000 points against ours 40000.
TEST(Quality, Shape4AgreesWithTheIndependentScript) {
    const AnalyticCylinder cylinder(3.12e-3, 2.96e-3);
    const TriangleMesh body = meshes::make_cylinder(3.12e-3, 2.96e-3, 256, true);
    const FitQuality quality = measure_quality(hand_made_shape(4), body, cylinder);
    EXPECT_NEAR(quality.volume_error, -0.0874, 1e-4);
    EXPECT_NEAR(quality.inertia_error[0], -0.138, 1e-3);
    EXPECT_NEAR(quality.inertia_error[2], -0.148, 1e-3);
    EXPECT_NEAR(quality.symmetric_difference, 0.0874, 3e-4);
    EXPECT_NEAR(quality.target_to_union.mean, 0.0478e-3, 0.0004e-3);  // 1 %
    EXPECT_NEAR(quality.target_to_union.rms, 0.0624e-3, 0.0006e-3);
    EXPECT_NEAR(quality.target_to_union.max, 0.2131e-3, 0.001e-3);
    EXPECT_NEAR(quality.union_to_target.mean, 0.0449e-3, 0.0004e-3);
    EXPECT_NEAR(quality.union_to_target.rms, 0.0572e-3, 0.0006e-3);
    EXPECT_NEAR(quality.union_to_target.max, 0.1828e-3, 0.004e-3);  // the script only sees its samples, we see the corners
    EXPECT_NEAR(quality.both.mean, 0.0464e-3, 0.0004e-3);
    EXPECT_NEAR(quality.both.rms, 0.0599e-3, 0.0006e-3);
    EXPECT_NEAR(quality.both.max, 0.2131e-3, 0.001e-3);
    EXPECT_LT(quality.centre_offset, 1e-8);
}

TEST(Quality, ConcentricSpheresAreKnownExactly) {
    const TriangleMesh body = meshes::make_sphere(2e-3, 5);
    class Ball final : public meshes::SignedDistance {
    public:
        double value(const Vec3& p) const override { return p.norm() - 1e-3; }
        Vec3 gradient(const Vec3& p) const override { return p.normalized(); }
        double error_bound() const override { return 1e-7; }
    } ball;
    for (const double radius : {0.9e-3, 1.1e-3}) {
        const FitQuality quality = measure_quality(std::vector<Sphere>{{Vec3::Zero(), radius}}, body, ball);
        const double gap = std::abs(radius - 1e-3), ratio = radius / 1e-3;
        EXPECT_NEAR(quality.volume_error, ratio * ratio * ratio - 1.0, 2e-3);  // the mesh of the ball is 0.1 % small
        EXPECT_NEAR(quality.inertia_error[1], std::pow(ratio, 5) - 1.0, 4e-3);
        EXPECT_NEAR(quality.both.mean, gap, 1e-6);
        EXPECT_NEAR(quality.both.rms, gap, 1e-6);
        EXPECT_NEAR(quality.both.max, gap, 1e-6);
        EXPECT_NEAR(quality.both.p99, gap, 1e-6);
        EXPECT_NEAR(quality.symmetric_difference, std::abs(ratio * ratio * ratio - 1.0), 3e-3);
        EXPECT_EQ(quality.distance_error_bound, 1e-7);
    }
}

TEST(Quality, SameBitsForOneAndTwoThreads) {
    const AnalyticCylinder cylinder(3.12e-3, 2.96e-3);
    const TriangleMesh body = meshes::make_cylinder(3.12e-3, 2.96e-3, 64);
    set_thread_count(1);
    const FitQuality one = measure_quality(hand_made_shape(3), body, cylinder);
    set_thread_count(2);
    const FitQuality two = measure_quality(hand_made_shape(3), body, cylinder);
    set_thread_count(0);
    EXPECT_EQ(one.both.mean, two.both.mean);
    EXPECT_EQ(one.both.rms, two.both.rms);
    EXPECT_EQ(one.symmetric_difference, two.symmetric_difference);
}

TEST(Quality, NoSpheresIsAnError) {
    EXPECT_THROW(measure_quality({}, meshes::make_box(Vec3::Zero(), Vec3::Ones()), AnalyticCylinder(1, 1)), Error);
}

TEST(UnionDistance, DepthAgreesWithADenseCloudOfTheSurface) {
    RandomStream random(3, 0);
    std::vector<Sphere> spheres;
    for (int i = 0; i < 25; ++i) spheres.push_back({{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, random.uniform(0.3, 0.7)});
    const auto boundary = detail::union_boundary(spheres);
    const detail::OuterSurface outer(spheres);
    const detail::UnionDistance distance(spheres, boundary, outer);
    const double spacing = 0.02;
    const auto cloud = detail::sample_union(spheres, boundary, outer, spacing);
    int inside = 0;
    for (int k = 0; k < 300; ++k) {
        const Vec3 p(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
        double nearest = 1e9;
        for (const Vec3& q : cloud.points) nearest = std::min(nearest, (p - q).norm());
        const double d = distance.value(p);
        inside += d < 0.0 ? 1 : 0;
        EXPECT_LE(std::abs(d), nearest + 1e-12) << k;    // the cloud can only be farther …
        EXPECT_GT(std::abs(d), nearest - spacing) << k;  // … by less than its spacing
    }
    EXPECT_GT(inside, 30);
}

TEST(UnionDistance, TheCreaseBetweenTwoBallsIsTheNearestPoint) {
    const std::vector<Sphere> two = {{{-0.6, 0, 0}, 1.0}, {{0.6, 0, 0}, 1.0}};
    const auto boundary = detail::union_boundary(two);
    const detail::OuterSurface outer(two);
    const detail::UnionDistance distance(two, boundary, outer);
    EXPECT_NEAR(distance.value({0, 0.1, 0}), -0.7, 1e-12);  // crease: circle of radius 0.8
    EXPECT_NEAR(distance.value({0, 0, 0}), -0.8, 1e-12);
    EXPECT_NEAR(distance.value({-0.7, 0, 0}), -0.9, 1e-12);
    EXPECT_NEAR(distance.value({2, 0, 0}), 0.4, 1e-12);
}

TEST(OuterSurface, ASealedHoleIsNoSurface) {
    // Six balls around the origin leave a hole there; twenty more close every window of it.
    std::vector<Sphere> spheres;
    for (int k = 0; k < 3; ++k) {
        for (const double side : {-1.0, 1.0}) {
            Vec3 c = Vec3::Zero();
            c[k] = side;
            spheres.push_back({c, 0.8});
        }
    }
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) spheres.push_back({Vec3(x, y, z) * 0.75, 0.75});
    const detail::OuterSurface outer(spheres);
    EXPECT_GT(outer.sealed_volume(), 0.0);
    EXPECT_FALSE(outer.reaches({0.2, 0, 0}));  // on the inner side of the ball at +x
    EXPECT_TRUE(outer.reaches({1.8, 0, 0}));
    const auto boundary = detail::union_boundary(spheres);
    for (const Vec3& p : detail::sample_union(spheres, boundary, outer, 0.05).points) EXPECT_GT(p.norm(), 0.9);
}

TEST(ColumnOverlap, BallInABox) {
    const TriangleMesh box = meshes::make_box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    const auto inside = detail::column_overlap(box, std::vector<Sphere>{{Vec3::Zero(), 0.9}}, 400);
    EXPECT_NEAR(inside.mesh, 8.0, 0.03);
    EXPECT_NEAR(inside.spheres, 4.0 / 3.0 * pi * 0.729, 1e-3);
    EXPECT_NEAR(inside.missing, inside.mesh - inside.spheres, 1e-9);
    EXPECT_NEAR(inside.outside, 0.0, 1e-12);
    const auto half = detail::column_overlap(box, std::vector<Sphere>{{Vec3(1, 0, 0), 0.5}}, 400);
    EXPECT_NEAR(half.outside, 0.5 * 4.0 / 3.0 * pi * 0.125, 5e-3);
}

TEST(SurfaceSamples, EqualAreasOnUnequalTriangles) {
    const TriangleMesh box = meshes::make_box(Vec3(0, 0, 0), Vec3(1, 2, 3));
    const auto samples = detail::sample_surface(box, 11000, 5);
    EXPECT_EQ(samples.points.size(), 11000u);
    EXPECT_NEAR(samples.area, 22.0, 1e-12);
    std::size_t top = 0, lower_half = 0;
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
        top += samples.normals[i].z() > 0.5 ? 1 : 0;
        lower_half += samples.points[i].z() < 1.5 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(top), 1000.0, 6.0);  // stratified: only strata at edges are uncertain
    EXPECT_NEAR(static_cast<double>(lower_half), 5500.0, 40.0);
}

}  // namespace
}  // namespace pelletlab::shapegen
