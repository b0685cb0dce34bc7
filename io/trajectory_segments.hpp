// A trajectory in pieces: HDF5 files that are still open when a program is killed may be lost, so a run that keeps checkpoints closes a piece at each of them.
// The pieces of a folder, «frames.0000.h5», «frames.0001.h5», …, become one run.h5 at the end.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "io/trajectory_file.hpp"

namespace pelletlab::io {

class SegmentedTrajectoryWriter {
public:
    /// Goes on behind the first `frames` frames that the folder's pieces hold; 0 begins anew. What lies behind them is removed: it will be written again.
    /// Error(bad_input) when the pieces do not hold that many frames, or a piece goes on behind them.
    SegmentedTrajectoryWriter(std::filesystem::path folder, const TrajectoryHeader& header, std::size_t frames);
    ~SegmentedTrajectoryWriter();
    SegmentedTrajectoryWriter(const SegmentedTrajectoryWriter&) = delete;
    SegmentedTrajectoryWriter& operator=(const SegmentedTrajectoryWriter&) = delete;

    void append(const Frame& frame);
    /// Closes the piece at hand and brings it to the disk: after that its frames survive whatever happens to the program.
    void secure();
    /// Makes `file` of all frames. The pieces stay: until the whole result is in its place a run may have to go on from them.
    void finish(const std::filesystem::path& file);

private:
    std::filesystem::path folder_;
    TrajectoryHeader header_;
    std::size_t closed_ = 0;  // pieces
    std::unique_ptr<TrajectoryWriter> open_;
};

/// Frames [0, frames) of the folder's pieces.
class SegmentedFrames {
public:
    explicit SegmentedFrames(const std::filesystem::path& folder);
    std::size_t frame_count() const;
    Frame frame(std::size_t index) const;

private:
    std::vector<std::unique_ptr<FrameSource>> pieces_;
};

}  // namespace pelletlab::io
