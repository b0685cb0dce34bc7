// A lying vessel's bed: levels of beds that are made by formula.
#include "observables/lying_bed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "documented.hpp"
#include "find.hpp"
#include "synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;

namespace {

constexpr double R = 0.05, L = 0.06, pellet_radius = 1e-3;

/// Spheres on a fine cubic lattice, every other layer shifted so that no line of sight passes, wherever they lie wholly below the level and in the vessel.
Trajectory filled_to(double level) {
    Frame frame;
    const double step = 2.0 * pellet_radius;
    int layer = 0;
    for (double z = level - pellet_radius; z > -R; z -= step, ++layer) {
        const double shift = layer % 2 == 0 ? 0.0 : pellet_radius;
        for (double y = -0.5 * L + pellet_radius + shift; y <= 0.5 * L - pellet_radius + 1e-12; y += step)
            for (double x = -R + shift; x <= R; x += step)
                if (std::hypot(x, z) <= R - pellet_radius) synthetic::add_body(frame, Vec3(x, y, z));
    }
    return synthetic::trajectory_of(synthetic::sphere_pellet(pellet_radius), {frame});
}

}  // namespace

TEST(LyingBed, SegmentsHaveTheirAreaAndCentroid) {
    EXPECT_NEAR(segment_area(1.0, 0.0), 0.5 * std::numbers::pi, 1e-15);
    EXPECT_NEAR(segment_area(1.0, 1.0), std::numbers::pi, 1e-15);
    EXPECT_NEAR(segment_area(1.0, -1.0), 0.0, 1e-15);
    EXPECT_NEAR(segment_centroid(1.0, 0.0), -4.0 / (3.0 * std::numbers::pi), 1e-15);  // half disc
    EXPECT_NEAR(segment_centroid(1.0, 1.0), 0.0, 1e-15);
}

TEST(LyingBed, FindsTheLevelOfABed) {
    for (const double level : {-0.02, 0.0, 0.015}) {
        const Observables result = measure_lying_bed(filled_to(level), {R, L, 0.5e-3});
        expect_documented(result);
        EXPECT_EQ(result.status, "complete");
        EXPECT_NEAR(find(result, "fill_level_highest").value, 1e3 * (R + level), 1e-9);
        // π/4 of the lines meet the top layer, on average r/3 below its tops; the others the layer below, a diameter deeper: 0.7 r, and the grid samples it.
        EXPECT_NEAR(find(result, "fill_level_grid").value, 1e3 * (R + level - 0.7 * pellet_radius), 0.3e3 * pellet_radius);
        // The lattice leaves a rim of r to 2 r of the vessel empty, which moves the centre by a part of that, and holds π/6 less that rim.
        EXPECT_NEAR(find(result, "fill_level_mass").value, 1e3 * (R + level), 1.5e3 * pellet_radius);
        EXPECT_NEAR(find(result, "fill_fraction_mass").value, segment_area(R, level) / (std::numbers::pi * R * R), 0.03);
        EXPECT_NEAR(find(result, "packing_fraction_mass").value, std::numbers::pi / 6.0, 0.08) << "a cubic lattice";
    }
}

TEST(LyingBed, AThinBedHasNoSurface) {
    Frame frame;
    for (int n = 0; n < 10; ++n) synthetic::add_body(frame, Vec3(0.0, -0.02 + 0.004 * n, -R + pellet_radius));
    const Observables result = measure_lying_bed(synthetic::trajectory_of(synthetic::sphere_pellet(pellet_radius), {frame}), {R, L, 1e-3});
    EXPECT_EQ(result.status, "thin bed");
    EXPECT_TRUE(std::isnan(find(result, "fill_level_grid").value));
    EXPECT_TRUE(std::isfinite(find(result, "fill_level_mass").value));
}

TEST(LyingBed, RefusesWhatCannotBeMeasured) {
    EXPECT_THROW(measure_lying_bed(filled_to(0.0), {0.0, L, 1e-3}), Error);
    EXPECT_THROW(measure_lying_bed(filled_to(0.0), {0.001, 0.001, 1e-3}), Error) << "no pellet inside";
}
