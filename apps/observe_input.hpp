// What `pelletlab observe` looks at: a run.h5 of our own, or a table of tracked particles.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/case.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::apps {

/// Options of the command line as they were typed; empty: not given.
struct TrajectoryRequest {
    std::filesystem::path file;
    std::string length_unit, time_unit, velocity_unit, frame_rate;
    std::string pellet_file, pellet_unit, pellet_diameter, pellet_density;
    std::string axis, up, origin;

    std::string settings() const;  ///< all of them in a fixed order, for the fingerprint of the stage
};

struct OpenedTrajectory {
    std::unique_ptr<FrameSource> frames;
    std::optional<Case> resolved_case;          ///< of a run of our own
    bool depth_known = true;                    ///< false: the file has no column for the coordinate along `axis`
    std::map<std::string, std::string> inputs;  ///< name → SHA-256, for the provenance
};

/// Opens the file and prints what a person wants to know of a table: rows, tracks, losses, columns that meant nothing.
/// Throws Error(usage) for options that do not go with the kind of file, Error(bad_input) for everything that is wrong with the file.
OpenedTrajectory open_for_observation(const TrajectoryRequest& request);

}  // namespace pelletlab::apps
