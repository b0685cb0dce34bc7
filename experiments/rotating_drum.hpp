// The rotating drum: pellets settle in the resting drum, the drum turns, and after a spin-up the bed is measured.
#pragma once

#include "packing/fill_tube.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::experiments {

/// The case's rig must be `drum`. Checkpoints as for fill_tube.
packing::RunResult run_drum(const Case& c, const packing::RunInputs& inputs, const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink,
                            const ProgressSink& progress, const packing::RunKeeping& keeping = {});

/// Pellets that the fill fraction asks for: fill_fraction · drum volume · bulk_packing_fraction / pellet volume, rounded.
std::uint32_t pellet_count(const DrumRig& drum, double pellet_volume);

}  // namespace pelletlab::experiments
