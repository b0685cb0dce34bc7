// What runs in a vessel that turns about the y axis have in common: pellets settle in it at rest, it turns, spins up, and is measured.
#pragma once

#include "packing/run_frames.hpp"
#include "packing/stage.hpp"

namespace pelletlab::experiments {

class TurningRun {
public:
    /// Opens the frames with the simulation as it stands, and settles. `simulation` outlives the run.
    TurningRun(const Case& c, const packing::RunInputs& inputs, solver::Simulation& simulation,
               const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink, const ProgressSink& progress, const packing::RunKeeping& keeping);

    TurningRun(const TurningRun&) = delete;  // the course's frames come here
    TurningRun& operator=(const TurningRun&) = delete;

    /// The walls that turn with the vessel begin to [rad/s], for time.spin_up.
    void spin_up(double speed);

    /// Runs the measurement: a stage with duration and watch, whose memory begins with its first time and its first frame. All its frames come to measured().
    void measure(packing::Stage& stage);

    packing::Course& course() { return course_; }
    const Trajectory& measured() const { return measured_; }

private:
    const Case& case_;
    solver::Simulation& simulation_;
    const packing::RunKeeping& keeping_;
    Trajectory measured_;
    bool measuring_ = false;
    packing::Course course_;
};

}  // namespace pelletlab::experiments
