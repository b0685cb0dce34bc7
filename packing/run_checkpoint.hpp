// What an interrupted run needs to go on as if nothing had happened: the simulation's own checkpoint and the place in the course of the run.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/trajectory.hpp"

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

enum class StageEnd : std::uint8_t { time_is_up, watch_ended_it };

struct RunCheckpoint {
    std::string simulation;       ///< solver::Simulation::checkpoint()
    std::vector<StageEnd> ended;  ///< the stages behind the run, in their order
    std::uint64_t done = 0;       ///< steps of the stage that it is in
    std::vector<double> memory;   ///< of that stage's watch
    std::uint64_t frames = 0;     ///< stored so far
    RunMeter meter;
};

/// Bytes with a checksum. `owner` names the run exactly (a fingerprint): checkpoint_from() refuses the bytes of another one.
std::string to_bytes(const RunCheckpoint& checkpoint, std::string_view owner);
/// Throws Error(bad_input) for damaged bytes and for those of another owner; `name` says in the message where the bytes come from.
RunCheckpoint checkpoint_from(std::string_view bytes, std::string_view owner, const std::string& name);

/// How a run keeps checkpoints and goes on from one; all may be empty.
struct RunKeeping {
    std::function<bool()> due;                       ///< asked between batches of steps
    std::function<void(const RunCheckpoint&)> keep;  ///< called when due, and before a run stops because of a signal
    std::optional<RunCheckpoint> from;               ///< go on from here
    std::function<Frame(std::size_t)> stored_frame;  ///< the frames that the run stored before `from`
};

}  // namespace pelletlab::packing
