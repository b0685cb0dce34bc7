#include <cmath>
#include <cstdio>
#include <numbers>

#include "packing/stage.hpp"

namespace pelletlab::packing {

namespace {

constexpr double rest_time = 0.02;        // [s] that the bed must stay quiet
constexpr double watch_interval = 0.001;  // [s]

/// m g d of the pellet: the energy of a fall through its own equivalent diameter [J].
double energy_scale(const solver::Simulation& simulation) {
    const MassProperties& mass = simulation.definition().templates.front().mass_properties;
    const double diameter = std::cbrt(6.0 * mass.volume / std::numbers::pi);
    return mass.mass * simulation.definition().gravity.norm() * diameter;
}

}  // namespace

SettleStatus settle(solver::Simulation& simulation, const Case& c, double frame_interval, const FrameSink& frames, const ProgressSink& progress,
                    RunMeter& meter) {
    const double scale = energy_scale(simulation), pellets = static_cast<double>(simulation.bodies().size());
    double relative_energy = 0.0, quiet_since = -1.0;
    Stage stage;
    stage.name = "settling";
    stage.duration = c.time.settle_limit;
    stage.frame_interval = frame_interval;
    stage.watch_interval = watch_interval;
    stage.watch = [&](const solver::Simulation& now) {
        const solver::EnergyReport energy = now.energy();
        relative_energy = (energy.kinetic_translation + energy.kinetic_rotation) / (pellets * scale);
        if (!(relative_energy < c.time.rest_kinetic_energy)) {
            quiet_since = -1.0;
        } else if (quiet_since < 0.0) {
            quiet_since = now.time();
        }
        return quiet_since >= 0.0 && now.time() - quiet_since >= rest_time * (1.0 - 1e-9);
    };
    stage.note = [&] {
        char text[64];
        std::snprintf(text, sizeof text, "kinetic energy %.1e m g d a pellet", relative_energy);
        return std::string(text);
    };
    return run_stage(simulation, stage, frames, progress, meter) == StageEnd::watch_ended_it ? SettleStatus::at_rest : SettleStatus::not_at_rest;
}

SettleStatus settle(solver::Simulation& simulation, const Case& c, const FrameSink& frames, const ProgressSink& progress) {
    RunMeter meter;
    return settle(simulation, c, c.output.frame_interval, frames, progress, meter);
}

}  // namespace pelletlab::packing
