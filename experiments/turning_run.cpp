#include "experiments/turning_run.hpp"

#include "packing/extra_walls.hpp"
#include "packing/wall_motions.hpp"

namespace pelletlab::experiments {

namespace {

constexpr double watch_interval = 0.001;  // [s] between looks at loads and overlaps
constexpr double sparse = 10.0;           // frames before the measurement are stored at this many times frame_interval

}  // namespace

TurningRun::TurningRun(const Case& c, const packing::RunInputs& inputs, solver::Simulation& simulation,
                       const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink, const ProgressSink& progress,
                       const packing::RunKeeping& keeping)
    : case_(c), simulation_(simulation), keeping_(keeping), course_(simulation, progress, keeping) {
    measured_.head = packing::trajectory_header(c, inputs, simulation);
    const packing::FrameSink stored = open_sink ? open_sink(measured_.head) : packing::FrameSink();
    course_.open(
        [this, stored](const Frame& frame) {
            if (stored) stored(frame);
            if (measuring_) measured_.frames.push_back(frame);
        },
        packing::capture_frame(simulation));
    packing::settle(course_, simulation, c, sparse * c.output.frame_interval);
}

void TurningRun::spin_up(double speed) {
    if (!course_.is_catching_up())
        packing::change_motions(
            simulation_, [&](const std::string& wall) { return packing::turns_with_vessel(case_, wall); },
            [&](solver::WallMotion& motion) { motion.axis = Vec3::UnitY(), motion.rotation_speed = speed; });
    packing::Stage stage;
    stage.name = "spinning up";
    stage.duration = case_.time.spin_up;
    stage.frame_interval = sparse * case_.output.frame_interval;
    stage.watch_interval = watch_interval;
    course_.run(stage);
}

void TurningRun::measure(packing::Stage& stage) {
    stage.name = "measuring";
    stage.frame_interval = case_.output.frame_interval;
    stage.watch_interval = watch_interval;
    stage.memory = {simulation_.time(), static_cast<double>(course_.frames_stored())};
    if (course_.is_catching_up())  // frames of the measurement that were stored before the run was stopped
        for (auto k = static_cast<std::size_t>(keeping_.from->memory.at(1)); k < course_.frames_stored(); ++k)
            measured_.frames.push_back(course_.stored_frame(k));
    measuring_ = true;
    course_.run(stage);
}

}  // namespace pelletlab::experiments
