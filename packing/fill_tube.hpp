// Tube filling: pellets fall into a vertical tube in one of several ways (packing/fill_ways.hpp), or as a cloud into a lying one, and come to rest.
#pragma once

#include "packing/run_checkpoint.hpp"
#include "packing/run_figures.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::packing {

/// The case's rig must be `tube`. `open_sink` is called once with the header and returns where frames go; frames are measured from memory. A run that goes on
/// from a checkpoint stores the frames that are still missing and has the result of the unbroken one, bit for bit (but for the time that it took).
RunResult fill_tube(const Case& c, const RunInputs& inputs, const std::function<FrameSink(const TrajectoryHeader&)>& open_sink, const ProgressSink& progress,
                    const RunKeeping& keeping = {});

}  // namespace pelletlab::packing
