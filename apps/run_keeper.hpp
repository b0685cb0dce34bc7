// Checkpoints of a run on the disk: one file with the state, and the frames that were stored up to it.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/run_stage.hpp"
#include "apps/stage.hpp"
#include "io/trajectory_segments.hpp"
#include "packing/run_checkpoint.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::apps {

/// The checkpoint in `folder` that the request wants to go on from; nothing when the run begins at the beginning. `owner` is the stage's fingerprint.
/// Throws Error(bad_input) when the request does not say what becomes of a checkpoint of this very case, and when it wants to go on from one of another.
std::optional<packing::RunCheckpoint> checkpoint_to_go_on_from(const std::filesystem::path& folder, const std::string& owner, const RunRequest& request);

class RunKeeper {
public:
    RunKeeper(StageFolder& stage, std::string owner, double interval, std::optional<packing::RunCheckpoint> from);

    /// Where frames go; for the rigs' open_sink.
    packing::FrameSink open(const TrajectoryHeader& header);
    packing::RunKeeping keeping();
    bool has_checkpoint() const { return has_checkpoint_; }
    /// Makes run.h5 of all frames.
    void finish(const std::filesystem::path& trajectory_file);

private:
    void keep(const packing::RunCheckpoint& checkpoint);

    StageFolder& stage_;
    std::string owner_;
    double interval_;
    std::optional<packing::RunCheckpoint> from_;
    bool has_checkpoint_;
    std::unique_ptr<io::SegmentedTrajectoryWriter> writer_;
    std::unique_ptr<io::SegmentedFrames> stored_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace pelletlab::apps
