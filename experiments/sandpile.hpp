// A pile on a flat plate: pellets come to rest in a closed funnel or in a cylinder on the plate, are released, and are measured when they rest again.
#pragma once

#include "packing/fill_tube.hpp"

namespace pelletlab::experiments {

/// The case's rig must be `pile`; otherwise as packing::fill_tube. The plate is z = 0, the axis of pouring the z axis. Stages: settling (closed), discharging
/// (at most pile.discharge_limit). `status` is that of observables::measure_pile, «not at rest» when the limit ended the discharge, «not discharged» when
/// nothing has reached the plate, and «funnel not empty» when the pellets are at rest with some of them still above the outlet.
packing::RunResult run_pile(const Case& c, const packing::RunInputs& inputs, const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink,
                            const ProgressSink& progress, const packing::RunKeeping& keeping = {});

}  // namespace pelletlab::experiments
