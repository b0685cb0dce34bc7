// Ways to fill a tube: all pellets arrive, in the rhythm that the case asks for, and a run goes on from any checkpoint.
#include "packing/fill_ways.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "kept_run.hpp"
#include "packing/fill_tube.hpp"
#include "small_case.hpp"

using namespace pelletlab;
using namespace pelletlab::packing;
using pelletlab::small_case::dumbbell_inputs;

namespace {

Case tube(const std::string& way, std::uint32_t count = 60) {
    Case c = small_case::tube_case(count);
    c.tube.diameter = 0.014;
    c.insertion.way = way;
    c.insertion.sieve_rate = 150.0;
    c.insertion.batches = 3;
    c.funnel.outlet_diameter = 0.012;
    c.funnel.top_diameter = 0.02;
    c.funnel.facets = 24;
    c.time.rest_kinetic_energy = 1e-4;
    c.output.frame_interval = 0.01;
    return c;
}

struct Filled {
    RunResult result;
    std::vector<Frame> frames;
    std::size_t bodies = 0, walls = 0;
};

Filled run_of(const Case& c, const RunKeeping& keeping = {}) {
    Filled run;
    run.result = fill_tube(
        c, dumbbell_inputs(),
        [&](const TrajectoryHeader& header) {
            run.bodies = header.shape_of_body.size();
            run.walls = header.walls.size();
            return kept_run::into(run.frames);
        },
        {}, keeping);
    return run;
}

std::size_t released(const Frame& frame) {
    std::size_t seen = 0;
    for (std::size_t body = 0; body < frame.positions.size(); ++body) seen += frame.is_seen(body) ? 1 : 0;
    return seen;
}

}  // namespace

TEST(FillWays, EveryWayEndsWithTheSamePelletsAtRest) {
    for (const char* way : {"cloud", "sieve", "batches", "funnel"}) {
        const Case c = tube(way);
        const Filled run = run_of(c);
        EXPECT_EQ(run.bodies, 60u) << way;
        EXPECT_EQ(run.walls, wall_names(c).size()) << way;
        EXPECT_NE(run.result.observables.status, "not at rest") << way;
        EXPECT_NE(run.result.observables.status, "funnel not empty") << way;
        for (const Frame& frame : run.frames) ASSERT_EQ(frame.positions.size(), 60u) << way;
        EXPECT_EQ(released(run.frames.back()), 60u) << way;
        for (const Observable& o : run.result.observables.values) {
            // 60 dumbbells of 3.5 mm³ in 154 mm² are 1.4 mm of solid: a bed of about 2 to 4 mm.
            if (o.name == "bed_height_mass") {
                EXPECT_NEAR(o.value, 3.0, 1.3) << way;
            }
            if (o.name == "pellets_counted") {
                EXPECT_EQ(o.value, 60.0) << way;
            }
        }
    }
}

TEST(FillWays, TheSieveKeepsItsRate) {
    const Case c = tube("sieve");
    const FillPlan plan = plan_fill(c, dumbbell_inputs().clump.rigid);
    // Layers of 2.05 bounding radii clear the sieve before the next one leaves: ½ g t² = 1.1 layers.
    EXPECT_NEAR(0.5 * 9.81 * plan.round_time * plan.round_time, 1.1 * 2.05 * 1.5e-3, 1e-9);
    const Filled run = run_of(c);
    for (const Frame& frame : run.frames) {
        if (released(frame) == 60u) break;
        // After the round in which the frame lies; whole pellets only.
        const double rounds = std::floor(frame.time / plan.round_time + 1e-6) + 1.0;
        EXPECT_NEAR(static_cast<double>(released(frame)), c.insertion.sieve_rate * plan.round_time * rounds, c.insertion.sieve_rate * plan.round_time + 1.0)
            << frame.time;
    }
    Case fast = c;
    fast.insertion.sieve_rate = 1e6;
    EXPECT_THROW(run_of(fast), Error);
    Case low = c;
    low.tube.height = 0.02;
    EXPECT_THROW(run_of(low), Error) << "the sieve does not fit";
    Case buried = c;
    buried.insertion.sieve_height = 0.003;
    EXPECT_THROW(run_of(buried), Error) << "lower than the bed will rise";
    Case afloat = c;
    afloat.gravity = Vec3::Zero();
    EXPECT_THROW(run_of(afloat), Error) << "nothing falls";
}

TEST(FillWays, BatchesComeToRestOneAfterTheOther) {
    const Filled run = run_of(tube("batches"));
    std::vector<std::size_t> counts;
    for (const Frame& frame : run.frames)
        if (counts.empty() || counts.back() != released(frame)) counts.push_back(released(frame));
    EXPECT_EQ(counts, (std::vector<std::size_t>{20, 40, 60}));
}

TEST(FillWays, TapsLiftTheTubeAndSetItDown) {
    Case c = tube("cloud");
    c.insertion.taps = 2;
    c.insertion.tap_frequency = 25.0;
    c.insertion.tap_amplitude = 0.002;
    c.output.frame_interval = 0.004;
    const Filled run = run_of(c), still = run_of(tube("cloud"));
    double highest = 0.0;
    for (const Frame& frame : run.frames) highest = std::max(highest, frame.wall_poses[0].position.z());
    EXPECT_NEAR(highest, 0.002, 1e-4) << "frames every tenth of a swing";
    EXPECT_NEAR(run.frames.back().wall_poses[0].position.z(), 0.0, 1e-12);
    EXPECT_NEAR(run.frames.back().wall_poses[1].position.z(), 0.0, 1e-12) << "the floor goes with the shell";
    EXPECT_NE(run.result.state_hash, still.result.state_hash);
}

TEST(FillWays, TapsLiftTheEndPlatesOfALyingTubeAsWell) {
    Case c = tube("cloud", 20);
    c.tube.lying = true;
    c.tube.height = c.tube.diameter = 0.02;
    c.insertion.taps = 1;
    c.insertion.tap_frequency = 25.0;
    c.insertion.tap_amplitude = 0.002;
    c.output.frame_interval = 0.004;
    const Filled run = run_of(c);
    bool lifted = false;
    for (const Frame& frame : run.frames) {
        lifted = lifted || frame.wall_poses[0].position.z() > 0.001;
        for (const Pose& pose : frame.wall_poses) EXPECT_EQ(pose.position.z(), frame.wall_poses[0].position.z());
    }
    EXPECT_TRUE(lifted);
}

TEST(FillWays, ALyingTubeHasAFillLevel) {
    Case c = tube("cloud");
    c.tube.lying = true;
    c.tube.height = 0.02;
    c.tube.diameter = 0.02;
    const Filled run = run_of(c);
    EXPECT_EQ(run.walls, 3u);
    double level = 0.0, counted = 0.0;
    for (const Observable& o : run.result.observables.values) {
        if (o.name == "fill_level_mass") level = o.value;
        if (o.name == "pellets_counted") counted = o.value;
    }
    EXPECT_EQ(counted, 60.0);
    EXPECT_GT(level, 2.0);
    EXPECT_LT(level, 8.0);
}

TEST(FillWays, SameBitsForOneAndTwoThreadsAndFromAnyCheckpoint) {
    for (const char* way : {"sieve", "batches", "funnel"}) {
        Case c = tube(way, 40);
        c.insertion.taps = 1;
        c.time.settle_limit = 0.15;
        std::vector<RunCheckpoint> checkpoints;
        set_thread_count(1);
        const Filled whole = run_of(c, kept_run::keep_every(97, checkpoints));
        set_thread_count(2);
        ASSERT_GE(checkpoints.size(), 2u) << way;
        for (const RunCheckpoint& checkpoint : checkpoints) {
            const Filled again = run_of(c, kept_run::go_on_from(checkpoint, whole.frames));
            EXPECT_EQ(again.result.state_hash, whole.result.state_hash) << way << " after " << checkpoint.ended.size() << " stages";
            EXPECT_EQ(again.frames.size() + checkpoint.frames, whole.frames.size()) << way;
        }
        set_thread_count(0);
    }
}
