// One stretch of simulated time that a rig steps through: frames are stored, progress is told, checkpoints are kept, and the person who waits can stop it.
// This loop is the one place where a run's simulated time passes, so a resumed run enters here.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "packing/run_checkpoint.hpp"
#include "packing/run_frames.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::packing {

struct Stage {
    std::string name;             ///< «settling»
    double duration = 0.0;        ///< [s] of simulated time, the most
    double frame_interval = 0.0;  ///< [s] between stored frames; 0: none but the last
    double watch_interval = 0.0;  ///< [s] between looks at the contacts and calls of `watch`; 0: never
    /// May be empty. Looks at the simulation; true ends the stage. What it wants to remember from call to call belongs into `memory`.
    std::function<bool(const solver::Simulation&, std::vector<double>& memory)> watch;
    std::vector<double> memory;  ///< at the beginning of the stage; a resumed stage gets back what it was
    /// For Progress::note; may be empty.
    std::function<std::string()> note;
};

/// The stages of one run, one after the other, with everything that they share.
class Course {
public:
    /// Brings the simulation (without bodies) to where `keeping.from` was, if there is such a place.
    Course(solver::Simulation& simulation, ProgressSink progress, RunKeeping keeping = {});

    /// Where frames go from now on (nowhere when empty), beginning with `first`, unless the run is behind itself.
    void open(FrameSink frames, const Frame& first);

    /// Steps through the stage. Frames are stored at every frame_interval after its beginning and at its end (once). Times are rounded to whole steps,
    /// intervals to at least one. Throws Error(interrupted) between two batches of steps after a signal, with a checkpoint kept. A stage that a resumed run has
    /// behind it is not run again. Afterwards stage.memory is what the watch left in it.
    StageEnd run(Stage& stage);

    /// True while what happens between stages has already happened: the resumed run was stopped in a later stage than those run so far. Placing bodies,
    /// starting walls and storing the first frame are for runs that are not behind themselves.
    bool is_catching_up() const { return keeping_.from.has_value(); }

    std::size_t frames_stored() const { return frames_stored_; }
    /// The k-th frame of the run; for those that were stored before a resumed run was stopped.
    Frame stored_frame(std::size_t k) const { return keeping_.stored_frame(k); }

    RunMeter meter;
    std::size_t pellets_in_all = 0;  ///< of a run that releases them one after the other: what its frames have room for

private:
    void store(const Frame& frame);
    void keep(const Stage& stage, std::uint64_t done);
    solver::Simulation& simulation_;
    FrameSink frames_;
    ProgressSink progress_;
    RunKeeping keeping_;
    std::vector<StageEnd> ended_;
    std::size_t frames_stored_ = 0;
};

/// The beginning of a stage's time, and steps in it: whole ones, at least one for a time above zero.
std::uint64_t steps_in(double time, double step);

enum class SettleStatus { at_rest, not_at_rest };

/// Steps until the pellets are at rest (packing/rest.hpp), or until time.settle_limit.
SettleStatus settle(Course& course, const solver::Simulation& simulation, const Case& c, double frame_interval, const std::string& name = "settling");

}  // namespace pelletlab::packing
