// Tube filling: pellets fall into a vertical tube in one of several ways (packing/fill_ways.hpp), or as a cloud into a lying one, and come to rest.
#pragma once

#include "core/observables.hpp"
#include "packing/run_checkpoint.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::packing {

struct RunResult {
    Observables observables;
    std::uint64_t state_hash = 0;
    std::uint64_t steps = 0;
    double wall_seconds = 0.0;  ///< of stepping alone
    double pellet_steps_per_second = 0.0;
};

/// The case's rig must be `tube`. `open_sink` is called once with the header and returns where frames go; frames are measured from memory. A run that goes on
/// from a checkpoint stores the frames that are still missing and has the result of the unbroken one, bit for bit (but for the time that it took).
RunResult fill_tube(const Case& c, const RunInputs& inputs, const std::function<FrameSink(const TrajectoryHeader&)>& open_sink, const ProgressSink& progress,
                    const RunKeeping& keeping = {});

}  // namespace pelletlab::packing
