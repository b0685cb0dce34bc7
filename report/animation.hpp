// Films as numbered pictures: all frames of a trajectory, or one frame seen from all round.
#pragma once

#include <filesystem>
#include <vector>

#include "core/progress.hpp"
#include "report/pictures.hpp"

namespace pelletlab::report {

enum class Subject { tube, drum };

struct AnimationSettings {
    PictureSettings picture;     ///< view and colour range are fixed for the whole film, from all frames, where they are not given here
    std::size_t every = 1;       ///< takes each n-th frame
    std::string stem = "frame";  ///< files are «frame_00000.png», «frame_00001.png», …
};

/// Files in their order. The folder is made when it is missing. Throws Error(bad_input) for a trajectory without frames or a folder that cannot be
/// written, Error(interrupted) after a signal; pictures finished by then stay.
std::vector<std::filesystem::path> render_animation(const FrameSource& trajectory, Subject subject, const std::filesystem::path& folder,
                                                    const AnimationSettings& settings, const ProgressSink& progress = {});

/// A tube's frame from `steps` directions once round the axis.
std::vector<std::filesystem::path> render_turntable(const TrajectoryHeader& header, const Frame& frame, std::size_t steps, const std::filesystem::path& folder,
                                                    const AnimationSettings& settings, const ProgressSink& progress = {});

}  // namespace pelletlab::report
