// A stretch of a run: steps taken in small batches between which frames are stored, progress is told, and the person who waits can stop it.
// This loop is the one place where a run's simulated time passes, so it is where checkpoints will be taken and resumed runs will enter.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/progress.hpp"
#include "packing/run_frames.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::packing {

/// What stepping has cost so far.
struct RunMeter {
    std::uint64_t steps = 0;
    double wall_seconds = 0.0;           ///< of stepping alone
    double largest_overlap_ratio = 0.0;  ///< overlap / radius of the smaller sphere, of all contacts at all watch times so far

    double pellet_steps_per_second(std::size_t pellets) const {
        return wall_seconds > 0.0 ? static_cast<double>(steps) * static_cast<double>(pellets) / wall_seconds : 0.0;
    }
};

struct Stage {
    std::string name;             ///< «settling»
    double duration = 0.0;        ///< [s] of simulated time, the most
    double frame_interval = 0.0;  ///< [s] between stored frames; 0: none but the last
    double watch_interval = 0.0;  ///< [s] between looks at the contacts and calls of `watch`; 0: never
    /// May be empty. Looks at the simulation (and may keep what it sees); true ends the stage.
    std::function<bool(const solver::Simulation&)> watch;
    /// For Progress::note; may be empty.
    std::function<std::string()> note;
};

enum class StageEnd { time_is_up, watch_ended_it };

/// Steps through the stage. Frames are stored at every frame_interval after its beginning and at its end (once). Times are rounded to whole steps, intervals to
/// at least one. Throws Error(interrupted) between two batches of steps after a signal.
StageEnd run_stage(solver::Simulation& simulation, const Stage& stage, const FrameSink& frames, const ProgressSink& progress, RunMeter& meter);

/// settle() of run_frames.hpp with its cost added to `meter` and a frame interval of its own.
SettleStatus settle(solver::Simulation& simulation, const Case& c, double frame_interval, const FrameSink& frames, const ProgressSink& progress,
                    RunMeter& meter);

}  // namespace pelletlab::packing
