#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic_cylinder.hpp"
#include "core/random.hpp"
#include "meshes/makers.hpp"
#include "shapegen/detail/edge_band.hpp"
#include "shapegen/detail/feature_edges.hpp"
#include "shapegen/detail/gap_shape.hpp"
#include "shapegen/fit.hpp"
#include "shapegen/quality.hpp"
#include "shapegen/surface_report.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen {
namespace {

constexpr double diameter = 3.12e-3, height = 2.96e-3;

TriangleMesh pellet() {
    return meshes::make_cylinder(diameter, height, 128, true);
}
const AnalyticCylinder& cylinder() {
    static const AnalyticCylinder instance(diameter, height);
    return instance;
}

FitResult fit_pellet(std::uint32_t spheres, FitMode mode) {
    FitSettings settings;
    settings.sphere_count = spheres;
    settings.mode = mode;
    return fit_spheres(pellet(), cylinder(), settings);
}

TEST(FitModes, MinimaxReachesTheGoals) {
    const std::pair<std::uint32_t, double> goals[] = {{24, 0.20e-3}, {82, 0.10e-3}};  // issue 3; 200 spheres take too long for a unit test
    for (const auto& [spheres, largest] : goals) {
        const FitResult fit = fit_pellet(spheres, FitMode::minimax);
        const FitQuality quality = measure_quality(fit.spheres, pellet(), cylinder());
        EXPECT_LE(quality.both.max, largest) << spheres;
        EXPECT_NEAR(quality.volume_error, 0.0, 1e-5) << spheres;
    }
}

TEST(FitModes, InsideNothingPokesOut) {
    const FitResult fit = fit_pellet(82, FitMode::inside);
    for (const Sphere& sphere : fit.spheres) EXPECT_LE(sphere.radius + cylinder().value(sphere.centre), 1e-12);
    const FitQuality quality = measure_quality(fit.spheres, pellet(), cylinder());
    EXPECT_GE(quality.volume_error, -0.065);  // issue 3
    EXPECT_LT(quality.volume_error, 0.0);
}

TEST(FitModes, OutsideCoversTheBody) {
    const FitResult fit = fit_pellet(40, FitMode::outside);
    RandomStream random(1, 0);
    for (int k = 0; k < 20000; ++k) {  // the surface and the inside
        const double angle = random.uniform(0, 6.283185307179586), deep = k % 2 == 0 ? 1.0 : std::sqrt(random.uniform());
        Vec3 p(0.5 * diameter * std::cos(angle) * deep, 0.5 * diameter * std::sin(angle) * deep, height * random.uniform(-0.5, 0.5));
        if (k % 4 == 1) p.z() = std::copysign(0.5 * height, p.z());
        double gap = 1.0;
        for (const Sphere& sphere : fit.spheres) gap = std::min(gap, (p - sphere.centre).norm() - sphere.radius);
        EXPECT_LE(gap, 2e-9);  // facets of the mesh lie a little inside and outside of the circle
    }
    EXPECT_LT(union_volume(fit.spheres) / (3.141592653589793 * 0.25 * diameter * diameter * height), 1.30);
}

TEST(FitModes, FlatPolesAreLevel) {
    const FitResult fit = fit_pellet(40, FitMode::flat);
    for (const double side : {-1.0, 1.0}) {
        std::vector<double> tops;
        for (const Sphere& sphere : fit.spheres) tops.push_back(side * sphere.centre.z() + sphere.radius);
        std::sort(tops.rbegin(), tops.rend());
        std::size_t level = 0;
        while (level < tops.size() && tops[0] - tops[level] < 1e-10) ++level;
        EXPECT_GE(level, 10u) << side;  // far more than the three that a resting body needs
    }
    const FitQuality flat = measure_quality(fit.spheres, pellet(), cylinder());
    const FitQuality mean = measure_quality(fit_pellet(40, FitMode::mean).spheres, pellet(), cylinder());
    EXPECT_LT(flat.both.rms / mean.both.rms, 1.15);  // what levelling costs: 4 % at 82 spheres
    EXPECT_NEAR(flat.volume_error, 0.0, 1e-5);
}

TEST(EdgeBand, HoldsWhatIsNearAnEdgeAndWeighsTheRest) {
    // A box with edges of 2, 3 and 4: one cut to a band of 0.3 along its edges, against the distance in closed form.
    const TriangleMesh box = meshes::make_box(Vec3(0, 0, 0), Vec3(2, 3, 4));
    const detail::SmoothPatches patches = detail::smooth_patches(box, 0.5);
    ASSERT_EQ(patches.edges.size(), 12u);
    const detail::EdgeBand band(patches.edges, 0.3);
    detail::SampleBlocks samples = detail::make_blocks(detail::sample_surface(box, 8000, 1));
    std::size_t inside = 0;
    for (const Vec3& p : samples.points) {
        Vec3 from = p.cwiseMin(Vec3(2, 3, 4) - p);  // from the six faces: 0, then the distance to the nearest edge
        std::sort(from.data(), from.data() + 3);
        EXPECT_EQ(band.holds(p), std::hypot(from[0], from[1]) < 0.3);
        inside += band.holds(p) ? 1 : 0;
    }
    ASSERT_GT(inside, 1000u);
    ASSERT_LT(inside, samples.size() - 1000u);
    EXPECT_FALSE(band.holds(Vec3(1, 1.5, 2)));
    EXPECT_FALSE(band.holds(Vec3(50, 0, 0)));
    detail::weigh_apart_from_edges(samples, band, 3.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        sum += samples.weight[k];
        EXPECT_NEAR(samples.weight[k] / samples.weight[0], (band.holds(samples.points[k]) ? 1.0 : 3.0) / (band.holds(samples.points[0]) ? 1.0 : 3.0), 1e-12);
    }
    EXPECT_NEAR(sum / static_cast<double>(samples.size()), 1.0, 1e-12);
}

TEST(FitModes, FacesOfTheMeanFitAreSmooth) {
    // Roughness asked for by issue 3 at 24 spheres; at 82 and 200 the table of benchmarks/clump_table shows it.
    const SurfaceReport report = measure_surface(fit_pellet(24, FitMode::mean).spheres, pellet(), cylinder());
    EXPECT_LE(report.flat_sq, 0.044e-3);
    EXPECT_LE(report.curved_sq, 0.048e-3);
}

TEST(GapShape, SlopeAndBendAreDerivatives) {
    const detail::GapShape shape{8, 0.5, 2.0, 3.0};
    for (const double x : {-0.4, -0.1, 0.2, 0.6}) {
        const double h = 1e-5;
        const auto at = [&](double d) { return detail::charge(shape, d, d > 0.0); };
        EXPECT_NEAR(2.0 * at(x).half_slope, (at(x + h).value - at(x - h).value) / (2 * h), 1e-6);
        EXPECT_NEAR(2.0 * at(x).half_bend, (at(x + h).half_slope - at(x - h).half_slope) / h, 1e-4);
    }
    EXPECT_DOUBLE_EQ(detail::charge({}, 0.3, true).value, 0.09);
}

TEST(FeatureEdges, RimsAndFlatFacesOfACylinder) {
    const TriangleMesh body = pellet();
    const auto rim = detail::sharp_edge_points(body, 0.5, 0.05e-3);
    EXPECT_GT(rim.size(), 2u * 128u);
    for (const Vec3& p : rim) EXPECT_NEAR(std::abs(p.z()), 0.5 * height, 1e-12);
    const auto faces = detail::flat_faces(body, 0.02);
    ASSERT_EQ(faces.size(), 2u);  // each facet of the side is below 2 %
    for (const auto& face : faces) {
        EXPECT_NEAR(std::abs(face.normal.z()), 1.0, 1e-9);
        EXPECT_NEAR(face.level, 0.5 * height, 1e-12);
        EXPECT_NEAR(face.area / (3.141592653589793 * 0.25 * diameter * diameter), 1.0, 1e-3);
    }
}

}  // namespace
}  // namespace pelletlab::shapegen
