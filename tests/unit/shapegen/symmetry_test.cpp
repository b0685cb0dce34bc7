#include "shapegen/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic_cylinder.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "meshes/makers.hpp"
#include "meshes/pellet_makers.hpp"
#include "shapegen/detail/symmetry_map.hpp"
#include "shapegen/fit.hpp"
#include "shapegen/quality.hpp"

namespace pelletlab::shapegen {
namespace {

constexpr double diameter = 3.12e-3, height = 2.96e-3;

TriangleMesh pellet() {
    return meshes::make_cylinder(diameter, height, 128, true);
}

FoundSymmetry found_in(const TriangleMesh& mesh) {
    return find_symmetry(mesh, *meshes::exact_signed_distance(mesh));
}

// Largest distance from a moved sphere to the nearest sphere of the clump, radius included.
double asymmetry(const std::vector<Sphere>& spheres, const Vec3& centre, const Mat3& motion) {
    double worst = 0.0;
    for (const Sphere& s : spheres) {
        const Vec3 moved = centre + motion * (s.centre - centre);
        double least = 1.0;
        for (const Sphere& t : spheres) least = std::min(least, (moved - t.centre).norm() + std::abs(s.radius - t.radius));
        worst = std::max(worst, least);
    }
    return worst;
}

TEST(FindSymmetry, OfSimpleBodies) {
    const FoundSymmetry cylinder = found_in(pellet());
    EXPECT_TRUE(cylinder.revolution);
    EXPECT_NEAR(std::abs(cylinder.symmetry.axis.z()), 1.0, 1e-9);
    EXPECT_EQ(cylinder.symmetry.mirrors.size(), 1u);  // across the axis

    const FoundSymmetry trilobe = found_in(meshes::make_pellet(meshes::LobedExtrudate{}, 90));
    EXPECT_FALSE(trilobe.revolution);
    EXPECT_EQ(trilobe.symmetry.fold, 3u);
    EXPECT_EQ(trilobe.symmetry.mirrors.size(), 2u);  // across the axis, and one that holds it

    const FoundSymmetry box = found_in(meshes::make_box({-1e-3, -2e-3, -3e-3}, {1e-3, 2e-3, 3e-3}));
    EXPECT_EQ(box.symmetry.fold, 2u);
    EXPECT_EQ(detail::SymmetryGroup::of(box.symmetry).elements.size(), 8u);

    TriangleMesh wedge = meshes::make_box({-1e-3, -2e-3, -3e-3}, {1e-3, 2e-3, 3e-3});
    for (Vec3& v : wedge.vertices) v.x() += 0.3 * v.z() + 60.0 * v.z() * v.y() + 90.0 * v.y() * v.y() + 40.0 * v.z() * v.z();
    EXPECT_TRUE(found_in(wedge).symmetry.trivial());
}

TEST(FindSymmetry, TurnsWithTheBody) {
    const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    const FoundSymmetry found = found_in(transformed(meshes::make_pellet(meshes::LobedExtrudate{}, 90), {{1e-3, 0, 0}, turn}));
    EXPECT_EQ(found.symmetry.fold, 3u);
    EXPECT_NEAR(std::abs(found.symmetry.axis.dot(turn * Vec3::UnitZ())), 1.0, 1e-6);
    EXPECT_EQ(found.symmetry.mirrors.size(), 2u);
}

TEST(SymmetryGroup, ElementsAndPlaces) {
    Symmetry symmetry;
    symmetry.fold = 4;
    symmetry.mirrors = {Vec3::UnitZ(), Vec3::UnitX()};
    const detail::SymmetryGroup group = detail::SymmetryGroup::of(symmetry);  // D4h
    EXPECT_EQ(group.elements.size(), 16u);
    EXPECT_EQ(group.places.front().moves.size(), 16u);
    EXPECT_EQ(group.places.back().moves.size(), 1u);  // the centre
    EXPECT_EQ(group.places.back().dimension, 0);
    for (const std::uint32_t n : {1u, 2u, 3u, 4u, 8u, 82u, 83u}) EXPECT_TRUE(group.can_hold(n)) << n;  // two on the axis and the centre fill up
    Symmetry inversion;  // three mirrors across each other: 8 elements, places of 8, 4, 2, 1
    inversion.mirrors = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    EXPECT_EQ(detail::SymmetryGroup::of(inversion).elements.size(), 8u);
    Symmetry wild;
    wild.fold = 7;
    wild.mirrors = {Vec3(1, 0, 0.3)};
    EXPECT_THROW(detail::SymmetryGroup::of(wild), Error);
}

TEST(SymmetryMap, SlopeFollowsTheChainRule) {
    Symmetry symmetry;
    symmetry.fold = 3;
    symmetry.mirrors = {Vec3::UnitZ()};
    const detail::SymmetryGroup group = detail::SymmetryGroup::of(symmetry);
    const detail::SymmetryMap map(group, {0, 1, group.places.size() - 1});
    RandomStream random(3, 0);
    detail::VectorXd y(12), weight(static_cast<Eigen::Index>(4 * map.spheres()));
    for (Eigen::Index k = 0; k < y.size(); ++k) y[k] = random.uniform(-1, 1);
    for (Eigen::Index k = 0; k < weight.size(); ++k) weight[k] = random.uniform(-1, 1);
    const detail::VectorXd slope = map.reduce(weight);
    for (Eigen::Index k = 0; k < y.size(); ++k) {  // the map is linear: any step will do
        detail::VectorXd moved = y;
        moved[k] += 1.0;
        EXPECT_NEAR(weight.dot(map.expand(moved) - map.expand(y)), slope[k], 1e-12) << k;
    }
}

TEST(SymmetricFit, RingsOfTheBodyItself) {
    const AnalyticCylinder cylinder(diameter, height);
    FitSettings settings;
    settings.sphere_count = 42;
    settings.symmetry_choice = SymmetryChoice::own;
    const FitResult fit = fit_spheres(pellet(), cylinder, settings);
    ASSERT_EQ(fit.spheres.size(), 42u);
    ASSERT_GT(fit.symmetry.fold, 2u);
    const Mat3 turn = Eigen::AngleAxisd(2.0 * M_PI / fit.symmetry.fold, fit.symmetry.axis).toRotationMatrix();
    EXPECT_LT(asymmetry(fit.spheres, Vec3::Zero(), turn), 1e-12);
    EXPECT_LT(asymmetry(fit.spheres, Vec3::Zero(), Vec3(1, 1, -1).asDiagonal()), 1e-12);
    const FitQuality with = measure_quality(fit.spheres, pellet(), cylinder);
    settings.symmetry_choice = SymmetryChoice::none;
    const FitQuality without = measure_quality(fit_spheres(pellet(), cylinder, settings).spheres, pellet(), cylinder);
    EXPECT_LT(with.both.rms / without.both.rms, 1.25);  // the price of rings
    EXPECT_NEAR(with.volume_error, 0.0, 1e-6);
}

TEST(SymmetricFit, GivenSymmetryOrAClearError) {
    const AnalyticCylinder cylinder(diameter, height);
    FitSettings settings;
    settings.sphere_count = 24;
    settings.symmetry_choice = SymmetryChoice::given;
    settings.symmetry.mirrors = {Vec3::UnitX(), Vec3(0, 1, 1)};
    const FitResult fit = fit_spheres(pellet(), cylinder, settings);
    EXPECT_EQ(fit.spheres.size(), 24u);
    EXPECT_LT(asymmetry(fit.spheres, Vec3::Zero(), Vec3(-1, 1, 1).asDiagonal()), 1e-12);
    settings.symmetry.mirrors.clear();
    settings.symmetry.fold = 0;
    EXPECT_THROW(fit_spheres(pellet(), cylinder, settings), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
