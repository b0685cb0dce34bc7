// Camera, speeds, circulation and mixing of drums whose motion is a formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "core/parallel.hpp"
#include "observables/detail/camera_view.hpp"
#include "observables/drum.hpp"
#include "observables/mixing.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/find.hpp"
#include "tests/unit/observables/synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;
using namespace pelletlab::synthetic;

namespace {

/// A level bed up to z = −level in a drum that turns about +y: a layer of that depth flows to the right with the speed of the surface at its top
/// and zero at its bottom; below it, everything goes to the left with the same gradient.
DrumBed sheared_bed(double level, double depth, double surface_speed) {
    DrumBed bed;
    bed.below = [=](double, double z) { return z < -level; };
    bed.velocity = [=](double, double z) { return Vec3(surface_speed * (1.0 - (-level - z) / depth), 0.0, 0.0); };
    return bed;
}

}  // namespace

TEST(DrumMotion, ActiveLayerOfALinearShear) {
    // A level of 16 mm below the axis leaves a bed of 24 mm at mid-chord; it flows 8 mm deep, with 0.3 m/s at the surface.
    const DrumBed bed = sheared_bed(0.016, 0.008, 0.3);
    const Observables drum = measure_drum(drum_trajectory(bed, 60, 0.01, 1), {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0});
    expect_documented(drum);
    // Points carry the velocity of their pellet's centre, which smears depths over a pellet but leaves a linear profile alone, except near the surface where
    // half pellets stick out: 0.1 mm of the place of the surface is the error of the depth.
    EXPECT_NEAR(find(drum, "active_layer_depth").value, 8.0, 0.5);
    EXPECT_NEAR(find(drum, "active_layer_thickness_share").value, 8.0 / 24.0, 0.025);
    EXPECT_NEAR(find(drum, "mid_chord_surface_speed").value, 0.3, 0.05);
    EXPECT_GT(find(drum, "active_layer_depth").standard_error, 0.0);
    // Speeds: uniform in height, so the distribution is known from the chord's width; its density adds up to one.
    const Profile& speeds = profile_of(drum, "speed_distribution");
    double sum = 0.0;
    for (const double density : speeds.value) sum += density * (speeds.axis[1] - speeds.axis[0]);
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_LT(find(drum, "speed_p10").value, find(drum, "speed_p50").value);
    EXPECT_LT(find(drum, "speed_p50").value, find(drum, "speed_p90").value);
    // |v| = 0.3 m/s · |1 − s/8 mm| at the depth s: between the mean over the flowing layer and the largest at the bottom, 0.3 · 16/8.
    EXPECT_GT(find(drum, "speed_p99").value, 0.45);
    EXPECT_LT(find(drum, "speed_p99").value, 0.6);
}

TEST(DrumMotion, GranularTemperatureIsTheVarianceOfOneComponent) {
    // Independent normal velocities of 0.05 m/s in each component: T = 0.0025 m²/s², whatever the mean.
    DrumBed bed;
    bed.below = [](double, double z) { return z < -0.016; };
    Trajectory trajectory = drum_trajectory(bed, 40, 0.01, 2);
    for (std::size_t k = 0; k < trajectory.frames.size(); ++k) {
        RandomStream random(77, k);
        for (Vec3& v : trajectory.frames[k].velocities) v = Vec3(0.2 + 0.05 * random.normal(), 0.05 * random.normal(), 0.05 * random.normal());
    }
    const Observables drum = measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0});
    // 40 · 700 pellets, three components: relative error √(2/84000) = 0.5 %; four of them.
    EXPECT_NEAR(find(drum, "granular_temperature").value, 0.0025, 0.0025 * 0.02);
    EXPECT_NEAR(find(drum, "granular_temperature_active").value, 0.0025, 0.0025 * 0.02) << "all cells go to the right, downhill";
}

TEST(DrumMotion, CameraSeesTheFrontPelletWithItsSurfaceVelocity) {
    // Two spheres of 4 mm, one behind the other, and one too deep to be seen.
    const double r = 2e-3;
    Frame frame;
    add_body(frame, {0.0, -8e-3, 0.0}, Quat::Identity(), {0.1, 0.0, 0.0}, {0.0, 50.0, 0.0});
    add_body(frame, {1e-3, -4e-3, 0.0}, Quat::Identity(), {0.0, 0.0, 0.7}, Vec3::Zero());
    add_body(frame, {10e-3, 5e-3, 0.0}, Quat::Identity(), {9.0, 0.0, 0.0}, Vec3::Zero());
    const Trajectory trajectory = trajectory_of(sphere_pellet(r), {frame, frame});
    const detail::CameraSums sums = detail::look(trajectory, {0, 1}, {40e-3, -10e-3, 8e-3, 0.5e-3});
    const std::vector<FieldMap> maps = detail::camera_maps(sums, {});
    const FieldMap &vx = maps[1], &vz = maps[2];
    std::size_t front = 0, behind = 0;
    for (std::size_t row = 0; row < vx.rows; ++row)
        for (std::size_t column = 0; column < vx.columns; ++column) {
            const std::size_t cell = row * vx.columns + column;
            const double x = vx.origin_horizontal + static_cast<double>(column) * vx.spacing, z = vx.origin_vertical + static_cast<double>(row) * vx.spacing;
            if (std::hypot(x, z) < r) {  // v + ω × arm, ω = 50 ŷ: vx = 0.1 + 50 z, vz = −50 x
                EXPECT_NEAR(vx.value[cell], 0.1 + 50.0 * z, 1e-12);
                EXPECT_NEAR(vz.value[cell], -50.0 * x, 1e-12);
                EXPECT_EQ(vx.sample_count[cell], 2.0);
                ++front;
            } else if (std::hypot(x - 1e-3, z) < r) {
                EXPECT_NEAR(vx.value[cell], 0.0, 1e-12);
                EXPECT_NEAR(vz.value[cell], 0.7, 1e-12);
                ++behind;
            } else {
                EXPECT_TRUE(std::isnan(vx.value[cell])) << x << " " << z;
            }
        }
    // Areas of the disc and of the crescent beside it, in cells of 0.25 mm²: 4π mm² and 4π − lens; the lattice leaves a few cells.
    EXPECT_NEAR(static_cast<double>(front), 4.0 * pi / 0.25, 5.0);
    const double lens = 2.0 * 4.0 * std::acos(0.25) - 0.5 * std::sqrt(16.0 - 1.0);
    EXPECT_NEAR(static_cast<double>(behind), (4.0 * pi - lens) / 0.25, 5.0);
}

TEST(DrumMotion, CameraSeesBoxesByTheirFaces) {
    // A box of 4 × 4 × 2 mm seen on its 4 × 2 mm face: exact triangles. A box whose near face lies just too deep is not seen.
    Frame frame;
    add_body(frame, {0.13e-3, 0.0, 0.17e-3});
    const Trajectory trajectory = trajectory_of(box_pellet(2e-3, 1e-3), {frame});
    const auto seen = [&](double depth) {
        const detail::CameraSums sums = detail::look(trajectory, {0}, {20e-3, -10e-3, depth, 0.5e-3});
        return static_cast<double>(std::count(sums.seen.begin(), sums.seen.end(), 1.0));
    };
    EXPECT_EQ(seen(8.001e-3), 8.0 * 4.0);
    EXPECT_EQ(seen(7.999e-3), 0.0);
}

TEST(DrumMotion, CirculationOfPelletsOnACarousel) {
    // Pellets on closed tracks: 0.3 s to the right at z = −18 mm, 0.9 s to the left at z = −30 mm (down and up in no time), phases spread evenly. A quarter of
    // them is active, each passage takes 0.3 s, each return 0.9 s.
    const PelletShape pellet = sphere_pellet(1.5e-3);
    std::vector<Frame> frames(240);
    for (std::size_t k = 0; k < frames.size(); ++k) {
        frames[k].time = 0.01 * static_cast<double>(k);
        RandomStream random(5, 0);
        for (int body = 0; body < 1200; ++body) {
            const double phase = std::fmod(frames[k].time + 1.2 * random.uniform(), 1.2), y = random.uniform(-8e-3, 8e-3),
                         scatter = random.uniform(-2e-3, 2e-3);
            if (phase < 0.3)
                add_body(frames[k], {-20e-3 + 40e-3 * phase / 0.3, y, -18e-3 + scatter}, Quat::Identity(), {40e-3 / 0.3, 0.0, 0.0});
            else
                add_body(frames[k], {20e-3 - 40e-3 * (phase - 0.3) / 0.9, y, -28e-3 + 3.0 * scatter}, Quat::Identity(), {-40e-3 / 0.9, 0.0, 0.0});
        }
    }
    const Observables drum = measure_drum(trajectory_of(pellet, std::move(frames)), {40e-3, 20e-3, 2.0, 2e-3}, {0.0, 10.0});
    // Passages are seen to a frame of 10 ms; over two turns of 1.2 s the pellets that begin or end amid a passage are counted by the share of time they show.
    EXPECT_NEAR(find(drum, "active_share").value, 0.25, 0.02);
    EXPECT_NEAR(find(drum, "active_residence_time").value, 0.3, 0.03);
    EXPECT_NEAR(find(drum, "passive_residence_time").value, 0.9, 0.06);
    EXPECT_NEAR(find(drum, "circulation_time").value, 1.2, 0.06);
}

TEST(DrumMotion, TorqueOfTheBedIsItsWeightTimesItsDistance) {
    // Pellets about x = −12 mm in a drum that turns about +y: the drive holds M g · 12 mm.
    DrumBed bed;
    bed.below = [](double x, double z) { return std::hypot(x + 12e-3, z + 16e-3) < 12e-3; };
    const Trajectory trajectory = drum_trajectory(bed, 40, 0.01, 3);
    const double mass = static_cast<double>(trajectory.head.shape_of_body.size()) * trajectory.head.shapes[0].rigid.mass_properties.mass;
    const Observables drum = measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0});
    // The mean of 40 · 300 places scatters by 6 mm/√12000 = 0.05 mm.
    EXPECT_NEAR(find(drum, "bed_torque").value, 1e3 * mass * 9.81 * 12e-3, 1e3 * mass * 9.81 * 0.3e-3);
    EXPECT_NEAR(find(drum, "bed_power").value, 2.0 * find(drum, "bed_torque").value, 1e-9);
}

TEST(DrumMotion, SlabAndFrontLayerSeeTheirPartOnly) {
    // The front 7 mm (two diameters) turn with the drum, the rest lies still.
    DrumBed bed;
    bed.below = [](double, double z) { return z < -0.012; };
    Trajectory trajectory = drum_trajectory(bed, 30, 0.01, 4);
    for (Frame& frame : trajectory.frames)
        for (std::size_t body = 0; body < frame.positions.size(); ++body) {
            const Vec3 p = frame.positions[body];
            if (p.y() < -1e-3) {
                frame.velocities[body] = {2.0 * p.z(), 0.0, -2.0 * p.x()};
                frame.spins[body] = {0.0, 2.0, 0.0};
            }
        }
    DrumGeometry geometry{bed.radius, bed.length, 2.0, 2e-3};
    const Observables whole = measure_drum(trajectory, geometry, {0.0, 1.0});
    EXPECT_NEAR(find(whole, "front_rigid_layer_rotation").value, 1.0, 0.02);
    EXPECT_NEAR(find(whole, "rigid_layer_rotation").value, 9.0 / 20.0, 0.04);
    geometry.slab_begin = 2e-3;
    geometry.slab_end = 10e-3;
    const Observables back = measure_drum(trajectory, geometry, {0.0, 1.0});
    EXPECT_NEAR(find(back, "rigid_layer_rotation").value, 0.0, 0.03);
    EXPECT_NEAR(find(back, "bed_packing_fraction").value, 0.6, 0.04) << "pellet volume in the slab per volume of the slab";
}

TEST(DrumMotion, LostPelletsAndTracersChangeNoAngle) {
    DrumBed bed;
    bed.below = [](double x, double z) { return z < -0.018 - x * std::tan(pi / 6.0); };
    Trajectory trajectory = drum_trajectory(bed, 60, 0.01, 6);
    const DrumGeometry geometry{bed.radius, bed.length, 2.0, 2e-3};
    // Every third observation is lost: each pellet that is seen stands for one and a half.
    for (std::size_t k = 0; k < trajectory.frames.size(); ++k)
        for (std::size_t body = k % 3; body < trajectory.frames[k].positions.size(); body += 3) trajectory.frames[k].positions[body].setConstant(not_known);
    DrumGeometry each = geometry;
    each.pellets_each = 1.5;
    const Observables drum = measure_drum(trajectory, each, {0.0, 1.0});
    EXPECT_NEAR(find(drum, "dynamic_angle_of_repose").value, 30.0, 0.7);
    EXPECT_NEAR(find(drum, "bed_packing_fraction").value, 0.6, 0.015);
    const Observables alone = measure_drum(trajectory, geometry, {0.0, 1.0});
    EXPECT_NEAR(find(alone, "dynamic_angle_of_repose").value, find(drum, "dynamic_angle_of_repose").value, 1e-9);
    EXPECT_NEAR(find(alone, "bed_packing_fraction").value, find(drum, "bed_packing_fraction").value / 1.5, 1e-9);
}

TEST(Mixing, LaceyIndexIsZeroForLayersAndOneForChance) {
    // 6 × 6 × 6 cells of 10 mm, whole cells labelled: unmixed. Labels at random: 1, within 4 standard deviations of S², √(2/K)/n̄ · S_0² …: 0.02 here.
    std::vector<Vec3> places;
    std::vector<std::uint8_t> layers, chance;
    RandomStream random(8, 0);
    for (int k = 0; k < 20000; ++k) {
        places.emplace_back(random.uniform(-5e-3, 55e-3), random.uniform(-5e-3, 55e-3), random.uniform(-5e-3, 55e-3));
        layers.push_back(places.back().z() < 25e-3 ? 1 : 0);
        chance.push_back(random.uniform() < 0.3 ? 1 : 0);
    }
    EXPECT_NEAR(lacey_index(places, layers, 10e-3), 0.0, 1e-9);
    EXPECT_NEAR(lacey_index(places, chance, 10e-3), 1.0, 0.01);
    // Half of the pellets of each layer exchanged at random: p = 1/4 and 3/4 in the cells, S² = 1/16 of S_0² = 1/4, so M = 1 − 1/4.
    std::vector<std::uint8_t> half = layers;
    for (std::uint8_t& label : half)
        if (random.uniform() < 0.25) label = label != 0 ? 0 : 1;
    EXPECT_NEAR(lacey_index(places, half, 10e-3), 0.75, 0.02);
    places[0].setConstant(not_known);
    EXPECT_NEAR(lacey_index(places, layers, 10e-3), 0.0, 1e-9) << "a lost pellet does not count";
    EXPECT_TRUE(std::isnan(lacey_index(places, std::vector<std::uint8_t>(places.size(), 1), 10e-3)));
}

TEST(DrumMotion, CameraHasTheSameBitsForAnyThreadCount) {
    DrumBed bed;
    bed.below = [](double, double z) { return z < -0.018; };
    const Trajectory trajectory = drum_trajectory(bed, 9, 0.01, 9);
    const auto measure = [&](int threads) {
        set_thread_count(threads);
        const Observables result = measure_drum(trajectory, {bed.radius, bed.length, 2.0, 2e-3}, {0.0, 1.0});
        set_thread_count(0);
        return result;
    };
    const Observables one = measure(1), two = measure(2);
    for (const char* name : {"camera_speed", "camera_velocity_fluctuation", "granular_temperature"})
        EXPECT_EQ(std::memcmp(map_of(one, name).value.data(), map_of(two, name).value.data(), map_of(one, name).value.size() * sizeof(double)), 0) << name;
}
