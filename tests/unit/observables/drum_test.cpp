#include "observables/drum.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/find.hpp"
#include "tests/unit/observables/synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;
using namespace pelletlab::synthetic;

namespace {

constexpr double degree = pi / 180.0;

/// Bed under the straight surface z = level − x tan(angle): high on the left, as in a drum that turns about +y.
std::function<bool(double, double)> under_straight_surface(double level, double angle) {
    return [=](double x, double z) { return z < level - x * std::tan(angle); };
}

}  // namespace

TEST(DrumMeasurement, StraightSurfaceOfThirtyDegreesIsFound) {
    DrumBed bed;
    bed.below = under_straight_surface(-0.018, 30.0 * degree);
    const Observables drum = measure_drum(drum_trajectory(bed, 60, 0.01, 1), {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0});
    expect_documented(drum);
    // Shot noise of the columns leaves 0.3° (60 frames × 300 spheres; observed scatter over seeds); smoothing over one diameter bends nothing on a straight
    // line.
    EXPECT_NEAR(find(drum, "upper_angle_of_repose").value, 30.0, 1.0);
    EXPECT_NEAR(find(drum, "lower_angle_of_repose").value, 30.0, 1.0);
    EXPECT_NEAR(find(drum, "dynamic_angle_of_repose").value, 30.0, 0.5);
    EXPECT_GT(find(drum, "upper_angle_of_repose").standard_error, 0.02);
    EXPECT_LT(find(drum, "upper_angle_of_repose").standard_error, 1.0);
    EXPECT_NEAR(find(drum, "bulk_packing_fraction").value, 0.6, 0.03);
    EXPECT_EQ(drum.status, "complete");

    // The surface itself: 50 % of a step smoothed symmetrically lies on the step.
    const Profile& surface = drum.profiles.at(0);
    std::size_t seen = 0;
    for (std::size_t k = 0; k < surface.axis.size(); ++k) {
        if (std::isnan(surface.value[k])) continue;
        ++seen;
        const double exact = -18.0 - surface.axis[k] * std::tan(30.0 * degree);
        const bool near_wall = std::hypot(surface.axis[k], exact) > 36.0;  // within a pellet diameter the averaging window is cut by the wall
        EXPECT_NEAR(surface.value[k], exact, near_wall ? 2.0 : 0.6) << "x = " << surface.axis[k] << " mm";
    }
    EXPECT_GE(seen, 30u);
}

TEST(DrumMeasurement, BedHeightAndFillLevelOfAHorizontalBed) {
    DrumBed bed;
    bed.below = under_straight_surface(-0.020, 0.0);
    const Observables drum = measure_drum(drum_trajectory(bed, 60, 0.01, 2), {bed.radius, bed.length, 0.0, 2e-3}, {0.0, 1.0});
    // Half the radius deep: bed height 20 mm above the lowest point (the highest of 70 noisy columns lies up to 1 mm above the mean), fill = (π/3 − √3/4)/π =
    // 0.1955.
    EXPECT_NEAR(find(drum, "bed_height").value, 20.5, 0.8);
    EXPECT_NEAR(find(drum, "fill_level").value, (pi / 3.0 - std::sqrt(3.0) / 4.0) / pi, 0.004);
    EXPECT_NEAR(find(drum, "bed_packing_fraction").value, 0.6, 0.012);
    EXPECT_NEAR(find(drum, "upper_angle_of_repose").value, 0.0, 1.0);
    EXPECT_NEAR(find(drum, "lower_angle_of_repose").value, 0.0, 1.0);
}

TEST(DrumMeasurement, SShapedSurfaceHasItsTwoAngles) {
    // Two straight halves that meet at x = 0: 45° uphill (left), 20° downhill (right).
    DrumBed bed;
    bed.below = [](double x, double z) { return z < -0.012 - x * std::tan((x < 0.0 ? 45.0 : 20.0) * degree); };
    const Observables drum = measure_drum(drum_trajectory(bed, 80, 0.01, 3), {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0});
    // The kink lies at s ≈ 0.45 of the surface in chord coordinates, so each fit is bent a little by it: 2° is allowed.
    EXPECT_NEAR(find(drum, "upper_angle_of_repose").value, 45.0, 3.0);
    EXPECT_NEAR(find(drum, "lower_angle_of_repose").value, 20.0, 2.0);
}

TEST(DrumMeasurement, TurningTheOtherWayMirrorsTheView) {
    DrumBed bed;
    bed.below = [](double x, double z) { return z < -0.012 + x * std::tan((x > 0.0 ? 45.0 : 20.0) * degree); };
    bed.velocity = [](double x, double z) { return Vec3(-2.0 * z, 0.0, 2.0 * x); };
    const Observables drum = measure_drum(drum_trajectory(bed, 80, 0.01, 3), {bed.radius, bed.length, -2.0, 2e-3}, {0.0, 1.0});
    EXPECT_NEAR(find(drum, "upper_angle_of_repose").value, 45.0, 3.0);
    EXPECT_NEAR(find(drum, "lower_angle_of_repose").value, 20.0, 2.0);
    EXPECT_NEAR(find(drum, "rigid_layer_rotation").value, 1.0, 0.02);
}

TEST(DrumMeasurement, RigidlyTurningBedHasSolidBodyVelocities) {
    constexpr double speed = 3.0;
    DrumBed bed;
    bed.spin = speed;
    bed.below = under_straight_surface(-0.018, 30.0 * degree);
    bed.velocity = [](double x, double z) { return Vec3(speed * z, 0.0, -speed * x); };  // Ω ŷ × r
    const Observables drum = measure_drum(drum_trajectory(bed, 40, 0.01, 4), {bed.radius, bed.length, speed, 2e-3}, {0.0, 1.0});
    // Pellets turn with the drum, so every volume point moves with Ω r; cells of 2 mm average over 2 mm: 1 % of the largest speed.
    EXPECT_NEAR(find(drum, "rigid_layer_rotation").value, 1.0, 0.01);
    const FieldMap& vx = map_of(drum, "vx");
    const FieldMap& vz = map_of(drum, "vz");
    const FieldMap& tremble = map_of(drum, "velocity_fluctuation");
    double worst = 0.0;
    std::size_t seen = 0;
    for (std::size_t r = 0; r < vx.rows; ++r)
        for (std::size_t c = 0; c < vx.columns; ++c) {
            const std::size_t cell = r * vx.columns + c;
            if (vx.sample_count[cell] < 75.0) continue;  // a full cell sees 40 · 0.6 · 80 mm³ / 22.4 mm³ = 86; others are centred off their middle
            const double x = vx.origin_horizontal + static_cast<double>(c) * vx.spacing, z = vx.origin_vertical + static_cast<double>(r) * vx.spacing;
            worst = std::max({worst, std::abs(vx.value[cell] - speed * z), std::abs(vz.value[cell] + speed * x)});
            EXPECT_LT(tremble.value[cell], speed * 2e-3);
            ++seen;
        }
    EXPECT_GT(seen, 200u);
    EXPECT_LT(worst, 0.01 * speed * bed.radius);
    // Downhill velocity at the surface's middle, one layer deep on average half a diameter below it: −Ω times the distance of that layer from the axis.
    const double distance = 0.018 * std::cos(30.0 * degree) + 0.5 * 2.0 * bed.pellet_radius;
    EXPECT_NEAR(find(drum, "surface_velocity").value, -speed * distance, 0.03 * speed * distance);
    EXPECT_GT(find(drum, "surface_velocity").standard_error, 0.0);
}

TEST(DrumMeasurement, DriftingAngleIsNotSteady) {
    DrumBed bed;
    bed.below = under_straight_surface(-0.018, 25.0 * degree);
    Trajectory trajectory = drum_trajectory(bed, 100, 0.01, 5);
    // The second half is the first turned by 6° about the axis.
    const Eigen::AngleAxisd turn(6.0 * degree, Vec3::UnitY());
    for (std::size_t k = 50; k < 100; ++k)
        for (Vec3& position : trajectory.frames[k].positions) position = turn * position;
    EXPECT_EQ(measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0}).status, "not steady");
    EXPECT_EQ(measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 0.495}).status, "complete");
}

TEST(DrumMeasurement, WindowChoosesTheFrames) {
    DrumBed bed;
    bed.below = under_straight_surface(-0.018, 30.0 * degree);
    const Trajectory trajectory = drum_trajectory(bed, 10, 0.1, 6);
    const Observables drum = measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {0.2, 0.5});
    EXPECT_NEAR(find(drum, "bed_height").window.begin, 0.2, 1e-12);
    EXPECT_NEAR(find(drum, "bed_height").window.end, 0.5, 1e-12);
    EXPECT_TRUE(std::isnan(find(drum, "bed_height").standard_error)) << "four frames cannot tell an error";
    EXPECT_THROW(measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {5.0, 6.0}), Error);
    EXPECT_THROW(measure_drum(trajectory, {bed.radius, 0.0, 2.0, 2e-3}, {0.0, 1.0}), Error);
    EXPECT_THROW(measure_drum(trajectory, {bed.radius, bed.length, 2.0, 1e-6}, {0.0, 1.0}), Error) << "absurd grid";
}

TEST(DrumMeasurement, SameBitsForAnyThreadCount) {
    DrumBed bed;
    bed.below = under_straight_surface(-0.018, 30.0 * degree);
    const Trajectory trajectory = drum_trajectory(bed, 23, 0.01, 7);
    const auto measure = [&](int threads) {
        set_thread_count(threads);
        const Observables result = measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0});
        set_thread_count(0);
        return result;
    };
    const Observables one = measure(1), two = measure(2), three = measure(3);
    for (std::size_t k = 0; k < one.values.size(); ++k) {
        EXPECT_EQ(std::memcmp(&one.values[k].value, &two.values[k].value, sizeof(double)), 0) << one.values[k].name;
        EXPECT_EQ(std::memcmp(&one.values[k].value, &three.values[k].value, sizeof(double)), 0) << one.values[k].name;
    }
    for (std::size_t m = 0; m < one.maps.size(); ++m)
        EXPECT_EQ(std::memcmp(one.maps[m].value.data(), two.maps[m].value.data(), one.maps[m].value.size() * sizeof(double)), 0) << one.maps[m].name;
}
