#include "shapegen/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analytic_cylinder.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/makers.hpp"
#include "shapegen/hand_made.hpp"
#include "shapegen/make_clump.hpp"
#include "shapegen/quality.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen {
namespace {

constexpr double diameter = 3.12e-3, height = 2.96e-3;

TriangleMesh pellet() {
    return meshes::make_cylinder(diameter, height, 128, true);
}

FitResult fit_pellet(std::uint32_t spheres, std::uint64_t seed = 1) {
    FitSettings settings;
    settings.sphere_count = spheres;
    settings.seed = seed;
    return fit_spheres(pellet(), AnalyticCylinder(diameter, height), settings);
}

struct Goal {
    std::uint32_t spheres;
    double mean, rms, volume, inertia;  // [m], [m], relative, relative
};

class FitGoals : public testing::TestWithParam<Goal> {};

// The goals of the issue for the cylinder; the referee of the distances is the analytic cylinder.
TEST_P(FitGoals, CylinderIsReached) {
    const Goal goal = GetParam();
    const FitResult fit = fit_pellet(goal.spheres);
    ASSERT_EQ(fit.spheres.size(), goal.spheres);
    const FitQuality quality = measure_quality(fit.spheres, pellet(), AnalyticCylinder(diameter, height));
    EXPECT_LE(quality.both.mean, goal.mean);
    EXPECT_LE(quality.both.rms, goal.rms);
    EXPECT_LE(std::abs(quality.volume_error), goal.volume);
    EXPECT_LE(quality.inertia_error.cwiseAbs().maxCoeff(), goal.inertia);
    EXPECT_NEAR(std::sqrt(fit.loss) / quality.both.rms, 1.0, 0.03);  // the fit knows how good it is, its depth inside being a lower bound
}

INSTANTIATE_TEST_SUITE_P(Issue3, FitGoals,
                         testing::Values(Goal{24, 0.043e-3, 0.053e-3, 5e-4, 1e-2}, Goal{82, 0.019e-3, 0.0235e-3, 2e-4, 2e-3},
                                         Goal{200, 0.010e-3, 0.0125e-3, 2e-4, 2e-3}),
                         [](const auto& info) { return "N" + std::to_string(info.param.spheres); });

TEST(Fit, FewSpheresAreExactlySoManyAndGetBetter) {
    double last = 1.0;
    for (const std::uint32_t n : {1u, 2u, 3u, 8u, 13u, 24u}) {
        const FitResult fit = fit_pellet(n);
        ASSERT_EQ(fit.spheres.size(), n);
        for (const Sphere& sphere : fit.spheres) EXPECT_GT(sphere.radius, 0.0);
        EXPECT_NEAR(union_volume(fit.spheres) / (3.141592653589793 * 0.25 * diameter * diameter * height), 1.0, 1e-3) << n;
        EXPECT_LT(fit.loss, last) << n;
        last = fit.loss;
    }
}

TEST(Fit, OneSphereOfABallIsTheBall) {
    const TriangleMesh ball = meshes::make_sphere(2e-3, 5);
    FitSettings settings;
    settings.sphere_count = 1;
    const auto distance = meshes::exact_signed_distance(ball);
    const FitResult fit = fit_spheres(ball, *distance, settings);
    EXPECT_NEAR(fit.spheres[0].radius, 1e-3, 1e-6);  // the mesh is up to 1e-6 m inside its sphere
    EXPECT_LT(fit.spheres[0].centre.norm(), 1e-6);
}

TEST(Fit, SameBitsForAnyThreadsAndForOneSeed) {
    set_thread_count(1);
    const FitResult one = fit_pellet(30, 5);
    set_thread_count(2);
    const FitResult two = fit_pellet(30, 5);
    set_thread_count(0);
    const FitResult other = fit_pellet(30, 6);
    bool differs = false;
    for (std::size_t i = 0; i < one.spheres.size(); ++i) {
        EXPECT_EQ(one.spheres[i].centre, two.spheres[i].centre) << i;
        EXPECT_EQ(one.spheres[i].radius, two.spheres[i].radius) << i;
        differs = differs || one.spheres[i].centre != other.spheres[i].centre;
    }
    EXPECT_TRUE(differs);
}

TEST(Fit, MovesWithTheBodyAndScalesWithIt) {
    // The same pellet turned, shifted and in metres instead of millimetres: the same quality (samples differ, so not the same spheres).
    FitSettings settings;
    settings.sphere_count = 24;
    const Pose pose{{0.5, -2.0, 3.0}, Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};
    TriangleMesh large = meshes::make_cylinder(3.12, 2.96, 128, true);
    large = transformed(large, pose);
    const auto distance = meshes::exact_signed_distance(large);
    const FitResult fit = fit_spheres(large, *distance, settings);
    EXPECT_NEAR(std::sqrt(fit.loss) / 0.0529, 1.0, 0.03);
    EXPECT_NEAR(union_volume(fit.spheres) / 22.63, 1.0, 1e-3);
}

TEST(Fit, MinimumRadiusHolds) {
    FitSettings settings;
    settings.sphere_count = 60;
    settings.min_radius = 0.5e-3;
    const FitResult fit = fit_spheres(pellet(), AnalyticCylinder(diameter, height), settings);
    double smallest = 1.0;
    for (const Sphere& sphere : fit.spheres) smallest = std::min(smallest, sphere.radius);
    EXPECT_GE(smallest, 0.5e-3 * (1.0 - 1e-12));
    EXPECT_LT(smallest, 0.51e-3);  // and it is felt
}

TEST(Fit, BoxWithItsSharpEdges) {
    const TriangleMesh box = meshes::make_box(Vec3(-1e-3, -1e-3, -1e-3), Vec3(1e-3, 1e-3, 1e-3));
    const auto distance = meshes::exact_signed_distance(box);
    FitSettings settings;
    settings.sphere_count = 64;
    const FitResult fit = fit_spheres(box, *distance, settings);
    const FitQuality quality = measure_quality(fit.spheres, box, *distance);
    EXPECT_LT(std::abs(quality.volume_error), 2e-4);
    EXPECT_LT(quality.both.rms, 0.03e-3);  // 1.5 % of the edge
}

TEST(Fit, ProgressNamesTheStages) {
    FitSettings settings;
    settings.sphere_count = 5;
    std::vector<std::string> stages;
    fit_spheres(pellet(), AnalyticCylinder(diameter, height), settings, [&](const Progress& progress) {
        if (stages.empty() || stages.back() != progress.stage) stages.push_back(progress.stage);
    });
    EXPECT_EQ(stages.size(), 5u);
}

TEST(Fit, BadSettingsAreErrors) {
    const TriangleMesh body = pellet();
    const AnalyticCylinder distance(diameter, height);
    const auto attempt = [&](FitSettings settings) { fit_spheres(body, distance, settings); };
    FitSettings settings;
    settings.sphere_count = 0;
    EXPECT_THROW(attempt(settings), Error);
    settings.sphere_count = 1000000;
    EXPECT_THROW(attempt(settings), Error);
    settings.sphere_count = 10;
    settings.min_radius = 0.01;
    EXPECT_THROW(attempt(settings), Error);
    settings.min_radius = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(attempt(settings), Error);
    settings.min_radius = 0.0;
    settings.effort = -1.0;
    EXPECT_THROW(attempt(settings), Error);
}

TEST(MakeClump, WholeWayFromTheMesh) {
    const TriangleMesh body = transformed(pellet(), {{1e-3, 2e-3, 0.5e-3}, Quat(Eigen::AngleAxisd(1.1, Vec3(1, 0, 1).normalized()))});
    ClumpSettings settings;
    settings.fit.sphere_count = 24;
    settings.voxel_fraction = 0.0;  // the exact route reaches the goal in any pose
    const MadeClump made = make_clump(body, settings);
    const FitQuality& quality = made.clump.quality;
    EXPECT_LT(quality.both.rms, 0.053e-3);
    EXPECT_LT(std::abs(quality.volume_error), 5e-4);
    EXPECT_GT(quality.distance_error_bound, 0.0);
    EXPECT_LT(quality.distance_error_bound, 1e-9);
    // Body frame: centre of mass in the origin, axis along z.
    const RigidTemplate& rigid = made.clump.rigid;
    ASSERT_EQ(rigid.spheres.size(), 24u);
    double side = 0.0, top = 0.0;
    for (const Sphere& sphere : rigid.spheres) {
        side = std::max(side, sphere.centre.head<2>().norm() + sphere.radius);
        top = std::max(top, std::abs(sphere.centre.z()) + sphere.radius);
    }
    EXPECT_NEAR(side, 0.5 * diameter, 0.12e-3);
    EXPECT_NEAR(top, 0.5 * height, 0.12e-3);
    EXPECT_NEAR(rigid.bounding_radius, std::hypot(0.5 * diameter, 0.5 * height), 0.2e-3);
    EXPECT_NEAR(rigid.mass_properties.mass, 1800.0 * 22.63e-9, 0.001 * 1800.0 * 22.63e-9);
    EXPECT_NEAR(rigid.mass_properties.principal_inertia[2] / (0.5 * rigid.mass_properties.mass * 0.25 * diameter * diameter), 1.0, 2e-3);
}

TEST(MakeClump, SearchingOnAGridIsTheDefaultAndLosesLittle) {
    ClumpSettings settings;
    settings.fit.sphere_count = 24;
    settings.measure_surface = false;
    const MadeClump by_grid = make_clump(pellet(), settings);
    settings.voxel_fraction = 0.0;
    const MadeClump by_exact_query = make_clump(pellet(), settings);
    bool same = true;
    for (std::size_t i = 0; i < by_grid.fit.spheres.size(); ++i) same = same && by_grid.fit.spheres[i].centre == by_exact_query.fit.spheres[i].centre;
    EXPECT_FALSE(same) << "the grid was not asked";
    EXPECT_LT(by_grid.clump.quality.both.rms, 1.02 * by_exact_query.clump.quality.both.rms);                   // measured: 1.00 (24), 1.01 (82), 1.02 (200)
    EXPECT_EQ(by_grid.clump.quality.distance_error_bound, by_exact_query.clump.quality.distance_error_bound);  // figures by the exact query
}

TEST(MakeClump, MassSources) {
    ClumpSettings settings;
    settings.fit.sphere_count = 12;
    settings.fit.match_volume = false;
    settings.measure_surface = false;
    const TriangleMesh body = pellet();
    const AnalyticCylinder exact(diameter, height);
    settings.mass_source = MassSource::union_of_spheres;
    const MadeClump made = make_clump(body, settings);
    const MassProperties spheres = made.clump.rigid.mass_properties;
    settings.mass_source = MassSource::target_mesh;
    const MassProperties mesh = judged_clump(made.fit.spheres, body, exact, settings).clump.rigid.mass_properties;
    settings.mass_source = MassSource::density_matched_union;
    const MassProperties matched = judged_clump(made.fit.spheres, body, exact, settings).clump.rigid.mass_properties;
    EXPECT_NE(spheres.volume, mesh.volume);
    EXPECT_EQ(spheres.density, 1800.0);
    EXPECT_NEAR(matched.mass / mesh.mass, 1.0, 1e-12);
    EXPECT_EQ(matched.volume, spheres.volume);
}

TEST(MakeClump, ASearchGridWorksToo) {
    ClumpSettings settings;
    settings.fit.sphere_count = 24;
    settings.voxel_fraction = 1.0 / 24.0;
    settings.measure_surface = false;
    EXPECT_LT(make_clump(pellet(), settings).clump.quality.both.rms, 0.056e-3);  // its error, up to 0.04 mm at the rim, costs a little
}

TEST(MakeClump, BadSettingsAreErrors) {
    ClumpSettings settings;
    settings.density = 0.0;
    EXPECT_THROW(make_clump(pellet(), settings), Error);
    settings.density = 1800.0;
    settings.voxel_fraction = -0.1;
    EXPECT_THROW(make_clump(pellet(), settings), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
