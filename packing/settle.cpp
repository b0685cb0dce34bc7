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

SettleStatus settle(Course& course, const solver::Simulation& simulation, const Case& c, double frame_interval) {
    const double scale = energy_scale(simulation);
    double relative_energy = 0.0;
    Stage stage;
    stage.name = "settling";
    stage.duration = c.time.settle_limit;
    stage.frame_interval = frame_interval;
    stage.watch_interval = watch_interval;
    stage.memory = {-1.0};  // since when it is quiet [s]; negative: it is not
    stage.watch = [&](const solver::Simulation& now, std::vector<double>& memory) {
        double& quiet_since = memory.at(0);
        const solver::EnergyReport energy = now.energy();
        relative_energy = (energy.kinetic_translation + energy.kinetic_rotation) / (static_cast<double>(now.bodies().size()) * scale);
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
    return course.run(stage) == StageEnd::watch_ended_it ? SettleStatus::at_rest : SettleStatus::not_at_rest;
}

}  // namespace pelletlab::packing
