// Runs that are stopped and go on: where their checkpoints and frames go, and what must be the same afterwards.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/observables.hpp"
#include "packing/run_checkpoint.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::kept_run {

inline packing::FrameSink into(std::vector<Frame>& frames) {
    return [&frames](const Frame& frame) { frames.push_back(frame); };
}

/// A checkpoint at every `period`-th question, into the list; none for 0.
inline packing::RunKeeping keep_every(int period, std::vector<packing::RunCheckpoint>& checkpoints) {
    packing::RunKeeping keeping;
    keeping.due = [period, asked = 0]() mutable { return period > 0 && ++asked % period == 0; };
    keeping.keep = [&checkpoints](const packing::RunCheckpoint& checkpoint) { checkpoints.push_back(checkpoint); };
    return keeping;
}

/// Goes on from a checkpoint of a run whose frames outlive it.
inline packing::RunKeeping go_on_from(const packing::RunCheckpoint& checkpoint, const std::vector<Frame>& frames) {
    packing::RunKeeping resume;
    resume.from = checkpoint;
    resume.stored_frame = [&frames](std::size_t k) { return frames.at(k); };
    return resume;
}

/// Every value the same to the last bit, or not known in both.
inline void expect_same_values(const Observables& a, const Observables& b) {
    ASSERT_EQ(a.values.size(), b.values.size());
    for (std::size_t k = 0; k < a.values.size(); ++k) {
        const Observable &one = a.values[k], &other = b.values[k];
        EXPECT_TRUE(one.value == other.value || (std::isnan(one.value) && std::isnan(other.value))) << one.name;
        EXPECT_EQ(one.window.begin, other.window.begin) << one.name;
    }
}

}  // namespace pelletlab::kept_run
