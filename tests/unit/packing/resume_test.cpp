// A run that goes on from any of its checkpoints is the unbroken run; damaged checkpoints are refused.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "kept_run.hpp"
#include "packing/fill_tube.hpp"
#include "small_case.hpp"

namespace pelletlab::packing {
namespace {

using small_case::dumbbell_inputs;
using small_case::tube_case;

struct Stored {
    std::vector<Frame> frames;
    std::vector<RunCheckpoint> checkpoints;
};

/// Runs the case with a checkpoint at every n-th question, into `stored`.
RunResult run(const Case& c, Stored& stored, int every, const RunCheckpoint* from = nullptr) {
    RunKeeping keeping = kept_run::keep_every(every, stored.checkpoints);
    if (from) {
        keeping.from = *from;
        stored.frames.resize(from->frames);
        const std::vector<Frame> before = stored.frames;
        keeping.stored_frame = [before](std::size_t k) { return before.at(k); };
    }
    return fill_tube(
        c, dumbbell_inputs(), [&](const TrajectoryHeader&) { return kept_run::into(stored.frames); }, {}, keeping);
}

TEST(Resume, AFilledTubeIsTheSameFromEveryCheckpoint) {
    const Case c = tube_case(30);
    Stored unbroken;
    const RunResult whole = run(c, unbroken, 15);
    ASSERT_GT(unbroken.checkpoints.size(), 3u);
    for (const RunCheckpoint& checkpoint : unbroken.checkpoints) {
        Stored resumed;
        resumed.frames = unbroken.frames;
        const RunCheckpoint read = checkpoint_from(to_bytes(checkpoint, "me"), "me", "test");
        const RunResult result = run(c, resumed, 0, &read);
        EXPECT_EQ(result.state_hash, whole.state_hash);
        EXPECT_EQ(result.steps, whole.steps);
        EXPECT_EQ(result.observables.status, whole.observables.status);
        ASSERT_EQ(result.observables.values.size(), whole.observables.values.size());
        for (std::size_t k = 0; k < whole.observables.values.size(); ++k)
            EXPECT_EQ(result.observables.values[k].value, whole.observables.values[k].value) << whole.observables.values[k].name;
        ASSERT_EQ(resumed.frames.size(), unbroken.frames.size());
        for (std::size_t k = 0; k < unbroken.frames.size(); ++k) {
            EXPECT_EQ(resumed.frames[k].time, unbroken.frames[k].time);
            EXPECT_EQ(resumed.frames[k].positions, unbroken.frames[k].positions);
        }
    }
}

RunCheckpoint some_checkpoint() {
    RunCheckpoint c;
    c.simulation = "bytes of a simulation";
    c.ended = {StageEnd::watch_ended_it, StageEnd::time_is_up};
    c.done = 1234567890123;
    c.memory = {-1.0, 0.25, 1e300};
    c.frames = 17;
    c.meter = {99, 12.5, 0.03};
    return c;
}

TEST(RunCheckpoint, ComesBackFromItsBytes) {
    const RunCheckpoint c = some_checkpoint();
    const RunCheckpoint back = checkpoint_from(to_bytes(c, "owner"), "owner", "test");
    EXPECT_EQ(back.simulation, c.simulation);
    EXPECT_EQ(back.ended, c.ended);
    EXPECT_EQ(back.done, c.done);
    EXPECT_EQ(back.memory, c.memory);
    EXPECT_EQ(back.frames, c.frames);
    EXPECT_EQ(back.meter.steps, c.meter.steps);
    EXPECT_EQ(back.meter.wall_seconds, c.meter.wall_seconds);
    EXPECT_EQ(back.meter.largest_overlap_ratio, c.meter.largest_overlap_ratio);
}

TEST(RunCheckpoint, DamageAndOtherOwnersAreRefused) {
    const std::string bytes = to_bytes(some_checkpoint(), "owner");
    const auto refuse = [](const std::string& what, const std::string& owner) {
        try {
            checkpoint_from(what, owner, "run.checkpoint");
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_EQ(error.place().file, "run.checkpoint");
            EXPECT_FALSE(error.remedy().empty());
        }
    };
    refuse(bytes, "another");
    for (std::size_t length = 0; length < bytes.size(); ++length) refuse(bytes.substr(0, length), "owner");
    refuse(bytes + "x", "owner");
    for (std::size_t at = 0; at < bytes.size(); ++at)
        for (const int bit : {0, 5}) {
            std::string turned = bytes;
            turned[at] = static_cast<char>(turned[at] ^ (1 << bit));
            refuse(turned, "owner");
        }
}

}  // namespace
}  // namespace pelletlab::packing
