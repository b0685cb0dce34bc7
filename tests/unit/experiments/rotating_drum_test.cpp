#include "experiments/rotating_drum.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/find.hpp"
#include "tests/unit/packing/kept_run.hpp"
#include "tests/unit/packing/small_case.hpp"

using namespace pelletlab;
using namespace pelletlab::experiments;
using pelletlab::small_case::drum_case;
using pelletlab::small_case::dumbbell_inputs;

TEST(PelletCount, FollowsFromTheFillFraction) {
    DrumRig drum;
    drum.diameter = 0.240;
    drum.length = 0.090;
    drum.fill_fraction = 0.20;
    drum.bulk_packing_fraction = 0.60;
    const double pellet_volume = 22.63e-9;
    // π/4 · 240² · 90 mm³ · 0.2 · 0.6 / 22.63 mm³ = 21590: the study's «22,000 pellets» within 2 %.
    EXPECT_EQ(pellet_count(drum, pellet_volume), 21590u);
    EXPECT_THROW(pellet_count(drum, 1.0), Error) << "less than one pellet";
    EXPECT_THROW(pellet_count(drum, 1e-20), Error) << "a pellet in the wrong unit";
}

TEST(RotatingDrum, LiftsItsBedOnTheLeft) {
    const Case c = drum_case(120);
    std::vector<Frame> frames;
    const auto result = run_drum(c, dumbbell_inputs(),
                                 [&](const TrajectoryHeader& header) {
                                     EXPECT_EQ(header.walls.size(), 3u);
                                     return packing::FrameSink([&](const Frame& frame) { frames.push_back(frame); });
                                 },
                                 {});
    expect_documented(result.observables);
    // 5 rad/s about +y carries the bottom towards −x, so the bed's surface is high on the left: its angle is positive and well above zero.
    EXPECT_GT(find(result.observables, "centre_of_mass_angle").value, 10.0);
    EXPECT_LT(find(result.observables, "centre_of_mass_angle").value, 70.0);
    // A bed of eight pellet diameters shears down to the wall, so its lower layer turns more slowly than the drum, and never faster.
    EXPECT_GT(find(result.observables, "rigid_layer_rotation").value, 0.3);
    EXPECT_LT(find(result.observables, "rigid_layer_rotation").value, 1.05);
    EXPECT_NEAR(find(result.observables, "bed_height").window.end - find(result.observables, "bed_height").window.begin, 0.19, 1e-6);
    // In the mean the drive balances the weight of the lifted bed, M g R_com sin β; the circle's segment of 20 % has its centre of mass at 0.70 R.
    const MassProperties& mass = dumbbell_inputs().clump.rigid.mass_properties;
    const double weight = 120 * mass.mass * 9.81,
                 arm = 0.7 * 0.5 * c.drum.diameter * std::sin(find(result.observables, "centre_of_mass_angle").value * std::numbers::pi / 180);
    EXPECT_NEAR(find(result.observables, "drum_torque").value, 1e3 * weight * arm, 0.3 * 1e3 * weight * arm);
    // Frames: the cloud, sparse ones of settling and spin-up, 20 of the measurement.
    ASSERT_GT(frames.size(), 22u);
    for (std::size_t k = frames.size() - 19; k < frames.size(); ++k) EXPECT_NEAR(frames[k].time - frames[k - 1].time, 0.01, 1e-9);
    EXPECT_GT(frames[1].time - frames[0].time, 0.05);
    // All three walls have turned by Ω t since the rotation began.
    const double turned = Eigen::AngleAxisd(frames.back().wall_poses[0].orientation).angle();
    EXPECT_NEAR(turned, c.drum.speed * (c.time.spin_up + c.time.measure), 1e-3);
    for (const Pose& pose : frames.back().wall_poses) EXPECT_TRUE(pose.orientation.isApprox(frames.back().wall_poses[0].orientation, 1e-12));
}

TEST(RotatingDrum, TheEnergyBookBalances) {
    Case c = drum_case(40);
    c.physics.energy_book = true;
    c.time.measure = 0.05;
    c.time.step *= 0.25;
    std::vector<Frame> frames;
    const auto inputs = dumbbell_inputs();
    const auto result =
        run_drum(c, inputs, [&](const TrajectoryHeader&) { return packing::FrameSink([&](const Frame& frame) { frames.push_back(frame); }); }, {});
    expect_documented(result.observables);
    const double mass = inputs.clump.rigid.mass_properties.mass;
    double start = 0.0;  // [mJ] of the cloud
    for (std::size_t i = 0; i < frames[0].positions.size(); ++i)
        start += 1e3 * mass * (9.81 * frames[0].positions[i].z() + 0.5 * frames[0].velocities[i].squaredNorm());
    double put_in = 0.0, there = 0.0, lost = 0.0;
    EXPECT_FALSE(result.energy_book.empty());
    for (const packing::BookLine& o : result.energy_book) {
        if (o.name.rfind("work_of_", 0) == 0 || o.name == "energy_fed")
            put_in += o.value;
        else if (o.name.rfind("dissipated_", 0) == 0)
            lost += o.value;
        else
            there += o.value;
    }
    EXPECT_GT(put_in, 0.0);
    EXPECT_GT(lost, 0.0);
    EXPECT_NEAR(start + put_in, there + lost, 2e-3 * (put_in + lost)) << "the time step's error: 5e-3 with the whole step";
}

TEST(RotatingDrum, EndPlatesMayStandStill) {
    Case c = drum_case(40);
    c.drum.end_plates_rotate = false;
    c.time.measure = 0.05;
    Frame last;
    run_drum(c, dumbbell_inputs(), [&](const TrajectoryHeader&) { return packing::FrameSink([&](const Frame& frame) { last = frame; }); }, {});
    EXPECT_GT(Eigen::AngleAxisd(last.wall_poses[0].orientation).angle(), 0.1);
    EXPECT_EQ(Eigen::AngleAxisd(last.wall_poses[1].orientation).angle(), 0.0);
    EXPECT_EQ(Eigen::AngleAxisd(last.wall_poses[2].orientation).angle(), 0.0);
}

TEST(RotatingDrum, SameBitsForOneAndTwoThreads) {
    Case c = drum_case(60);
    c.time.measure = 0.1;
    set_thread_count(1);
    const auto one = run_drum(c, dumbbell_inputs(), {}, {});
    set_thread_count(2);
    const auto two = run_drum(c, dumbbell_inputs(), {}, {});
    set_thread_count(0);
    EXPECT_EQ(one.state_hash, two.state_hash);
    EXPECT_EQ(find(one.observables, "upper_angle_of_repose").value, find(two.observables, "upper_angle_of_repose").value);
}

TEST(RotatingDrum, GoesOnFromAnyCheckpointAsIfNothingHadHappened) {
    Case c = drum_case(40);
    c.time.settle_limit = 0.05;
    c.time.spin_up = 0.05;
    c.time.measure = 0.1;
    std::vector<Frame> frames;
    std::vector<packing::RunCheckpoint> checkpoints;
    const auto store_in = [](std::vector<Frame>& list) { return [&list](const TrajectoryHeader&) { return kept_run::into(list); }; };
    const auto whole = run_drum(c, dumbbell_inputs(), store_in(frames), {}, kept_run::keep_every(30, checkpoints));
    std::set<std::size_t> stages;
    for (const packing::RunCheckpoint& checkpoint : checkpoints) {
        stages.insert(checkpoint.ended.size());
        std::vector<Frame> again(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(checkpoint.frames));
        const auto result = run_drum(c, dumbbell_inputs(), store_in(again), {}, kept_run::go_on_from(checkpoint, frames));
        EXPECT_EQ(result.state_hash, whole.state_hash);
        EXPECT_EQ(result.observables.status, whole.observables.status);
        kept_run::expect_same_values(whole.observables, result.observables);
        ASSERT_EQ(again.size(), frames.size());
        for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(again[k].positions, frames[k].positions) << k;
    }
    EXPECT_EQ(stages.size(), 3u) << "checkpoints in settling, spin-up and measurement";
}

TEST(RotatingDrum, TakesTheUsersOwnDrum) {
    Case c = drum_case(40);
    TriangleMesh drum;
    for (const TriangleMesh& part :
         {meshes::make_drum_shell(c.drum.diameter, c.drum.length, 36), meshes::make_drum_end(c.drum.diameter, -0.5 * c.drum.length, true, 36),
          meshes::make_drum_end(c.drum.diameter, 0.5 * c.drum.length, false, 36)}) {
        const auto offset = static_cast<std::uint32_t>(drum.vertices.size());
        drum.vertices.insert(drum.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const Triangle& face : part.faces) drum.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
    }
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("pelletlab_drum_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    meshes::write_stl(drum, folder / "drum.stl", "mm");
    c.folder = folder.string();
    c.drum.mesh_file = "drum.stl";
    c.drum.mesh_unit = "mm";
    c.time.measure = 0.1;
    const auto own = run_drum(c, dumbbell_inputs(), {}, {});
    EXPECT_GT(find(own.observables, "centre_of_mass_angle").value, 10.0);
    c.drum.mesh_unit = "m";
    EXPECT_THROW(run_drum(c, dumbbell_inputs(), {}, {}), Error) << "a drum of 30 m";
    std::filesystem::remove_all(folder);
}

TEST(RotatingDrum, RefusesACaseOfAnotherRig) {
    Case c = drum_case(10);
    c.rig = Rig::tube;
    EXPECT_THROW(run_drum(c, dumbbell_inputs(), {}, {}), Error);
}
