#include "shapegen/baselines/baselines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/pellet_makers.hpp"
#include "shapegen/fit.hpp"
#include "shapegen/quality.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen::baselines {
namespace {

constexpr double diameter = 3.12e-3, height = 2.96e-3, volume = std::numbers::pi * 0.25 * diameter * diameter * height;

const TriangleMesh& pellet() {
    static const TriangleMesh mesh = meshes::make_cylinder(diameter, height, 64, true);
    return mesh;
}

const meshes::SignedDistance& exact() {
    static const auto distance = meshes::exact_signed_distance(pellet());
    return *distance;
}

constexpr double cell_fraction = 1.0 / 40.0, cell = cell_fraction * height;

std::vector<Sphere> of(const std::string& id, std::uint32_t count) {
    BaselineSettings settings;
    settings.sphere_count = count;
    settings.cell_fraction = cell_fraction;
    return baseline(id, pellet(), exact(), settings);
}

TEST(Baselines, EachGivesSpheresInsideTheBody) {
    for (const Method& method : methods()) {
        const auto spheres = of(method.id, 24);
        ASSERT_FALSE(spheres.empty()) << method.id;
        EXPECT_LE(spheres.size(), 24u) << method.id;
        // OpenVDB's distance is off by less than a cell near the surface, Ferellec–McDowell's balls may reach out by 2e-3 of the extent, the others are exact.
        for (const Sphere& sphere : spheres) EXPECT_LT(sphere.radius + exact().value(sphere.centre), cell) << method.id;
        EXPECT_LT(union_volume(spheres), volume) << method.id;
        EXPECT_GT(union_volume(spheres), 0.5 * volume) << method.id;  // the largest inscribed ball alone has 0.6 of it
    }
}

TEST(Baselines, FavierLiesOnTheAxisAndTouchesTheSurface) {
    const auto spheres = of("favier", 7);
    EXPECT_EQ(spheres.size(), 7u);
    for (const Sphere& sphere : spheres) {
        EXPECT_LT(sphere.centre.head<2>().norm(), 1e-12);
        EXPECT_NEAR(sphere.radius, -exact().value(sphere.centre), 1e-15);
    }
}

TEST(Baselines, FerellecMcDowellMeetsTheWishedNumberAndTouchesTheSurface) {
    for (const std::uint32_t n : {24u, 82u}) {
        const auto spheres = of("ferellec", n);
        EXPECT_LE(spheres.size(), n);
        EXPECT_GE(spheres.size() + 3, n);  // neighbouring values of d_min differ by more than one sphere at times
        for (const Sphere& sphere : spheres) EXPECT_NEAR(sphere.radius, -exact().value(sphere.centre), 2.1e-3 * height);  // the tolerance
    }
}

TEST(Baselines, EuclideanMapStartsWithTheLargestBallAndKeepsCoresApart) {
    const auto spheres = of("euclidean", 24);
    ASSERT_EQ(spheres.size(), 24u);
    EXPECT_NEAR(spheres[0].radius, 0.5 * height, cell);
    for (std::size_t i = 0; i < spheres.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)  // no sphere reaches the core (1 − 0.6) r of an earlier one
            EXPECT_GE((spheres[i].centre - spheres[k].centre).norm() - spheres[i].radius, 0.4 * spheres[k].radius - 1e-12);
}

TEST(Baselines, SameBitsForAnyNumberOfThreads) {
    for (const Method& method : methods()) {
        set_thread_count(1);
        const auto one = of(method.id, 20);
        set_thread_count(2);
        const auto two = of(method.id, 20);
        set_thread_count(0);
        ASSERT_EQ(one.size(), two.size()) << method.id;
        for (std::size_t i = 0; i < one.size(); ++i) {
            EXPECT_EQ(one[i].centre, two[i].centre) << method.id;
            EXPECT_EQ(one[i].radius, two[i].radius) << method.id;
        }
    }
}

TEST(Baselines, VolumeMatchedHasTheVolume) {
    for (const Method& method : methods()) {
        const auto spheres = of(method.id, 20);
        const auto matched = volume_matched(spheres, volume);
        ASSERT_EQ(matched.size(), spheres.size()) << method.id;
        EXPECT_NEAR(union_volume(matched) / volume, 1.0, 1e-9) << method.id;
        for (std::size_t i = 0; i < spheres.size(); ++i)  // one common offset
            EXPECT_NEAR(matched[i].radius - spheres[i].radius, matched[0].radius - spheres[0].radius, 1e-15) << method.id;
    }
}

TEST(Baselines, VolumeMatchingHasAClosedFormForOneSphereAndShrinksToo) {
    const std::vector<Sphere> ball{{{1e-3, 0, 0}, 1e-3}};
    for (const double factor : {0.01, 1.0, 30.0}) {
        const double wanted = factor * 4.0 / 3.0 * std::numbers::pi * 1e-9;
        EXPECT_NEAR(volume_matched(ball, wanted)[0].radius / (1e-3 * std::cbrt(factor)), 1.0, 1e-10);
    }
    // A sphere that the offset eats up is left out.
    const std::vector<Sphere> two{{{0, 0, 0}, 1e-3}, {{5e-3, 0, 0}, 1e-5}};
    EXPECT_EQ(volume_matched(two, 0.5 * 4.0 / 3.0 * std::numbers::pi * 1e-9).size(), 1u);
}

// At equal N the fit beats all of them by 1.5 in rms. After the volume offset, which is a step of the fit too, the best one (OpenVDB) comes to 1.46.
TEST(Baselines, TheFitBeatsAllOfThem) {
    FitSettings settings;
    settings.sphere_count = 42;
    const double fitted = measure_quality(fit_spheres(pellet(), exact(), settings).spheres, pellet(), exact()).both.rms;
    for (const Method& method : methods()) {
        const auto spheres = of(method.id, 42);
        EXPECT_GT(measure_quality(spheres, pellet(), exact()).both.rms, 1.5 * fitted) << method.id;
        EXPECT_GT(measure_quality(volume_matched(spheres, volume), pellet(), exact()).both.rms, 1.4 * fitted) << method.id << ", volume-matched";
    }
}

TEST(Baselines, WorkOnATrilobeAndFavierRefusesARing) {
    const TriangleMesh trilobe = meshes::make_pellet(meshes::LobedExtrudate{}, 120);
    const auto inside = meshes::exact_signed_distance(trilobe);
    BaselineSettings settings;
    settings.sphere_count = 30;
    settings.cell_fraction = cell_fraction;
    const double body = meshes::mass_properties(trilobe, 1.0).volume;
    for (const Method& method : methods()) {
        if (method.id == "favier") continue;  // one row of spheres
        const double reached = union_volume(baseline(method.id, trilobe, *inside, settings)) / body;
        EXPECT_GT(reached, 0.6) << method.id;  // 0.66 for Ferellec–McDowell, whose random order wastes spheres
        EXPECT_LT(reached, 1.0) << method.id;
    }
    const TriangleMesh ring = meshes::make_pellet(meshes::HollowCylinder{}, 48);
    EXPECT_THROW(baseline("favier", ring, *meshes::exact_signed_distance(ring), settings), Error);  // its axis is in the hole
}

TEST(Baselines, UnknownNamesAndWrongSettingsAreErrors) {
    EXPECT_THROW(of("favourite", 5), Error);
    EXPECT_THROW(of("favier", 0), Error);
    EXPECT_THROW(of("favier", 2001), Error);
    EXPECT_THROW(volume_matched({}, 1.0), Error);
    EXPECT_THROW(volume_matched(std::vector<Sphere>{{Vec3::Zero(), 1.0}}, -1.0), Error);
    BaselineSettings settings;
    settings.overlap = 1.0;
    EXPECT_THROW(baseline("euclidean", pellet(), exact(), settings), Error);
    settings = {};
    settings.cell_fraction = 0.0;
    EXPECT_THROW(baseline("openvdb", pellet(), exact(), settings), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen::baselines
