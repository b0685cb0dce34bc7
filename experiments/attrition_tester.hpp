// Attrition tester (ASTM D4058): a drum with one baffle lifts pellets and drops them. What the pellets do against the baffle's angle.
#pragma once

#include "packing/fill_tube.hpp"

namespace pelletlab::experiments {

/// The case's rig must be `tester`; otherwise as packing::fill_tube. Stages: settling (drum at rest, baffle at tester.baffle_start), spinning up, measuring
/// over time.measure cut to whole turns.
packing::RunResult run_tester(const Case& c, const packing::RunInputs& inputs, const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink,
                              const ProgressSink& progress, const packing::RunKeeping& keeping = {});

}  // namespace pelletlab::experiments
