// run.h5: a trajectory in HDF5 (C API), appended frame by frame while the run goes on.
#pragma once

#include <filesystem>
#include <memory>

#include "core/trajectory.hpp"

namespace pelletlab::io {

/// Writes to «<file>.part» and renames on finish(); without finish() the part file is removed.
class TrajectoryWriter {
public:
    TrajectoryWriter(const std::filesystem::path& file, const TrajectoryHeader& header);
    ~TrajectoryWriter();
    TrajectoryWriter(const TrajectoryWriter&) = delete;
    TrajectoryWriter& operator=(const TrajectoryWriter&) = delete;
    void append(const Frame& frame);
    void finish();

private:
    struct File;
    std::unique_ptr<File> file_;
};

std::unique_ptr<FrameSource> open_trajectory(const std::filesystem::path& file);

}  // namespace pelletlab::io
