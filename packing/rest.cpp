#include "packing/rest.hpp"

#include <cmath>
#include <cstdio>

namespace pelletlab::packing {

namespace {

constexpr double rest_time = 0.02;  // [s] that the bed must stay quiet

/// m g d of the pellet: the energy of a fall through its own equivalent diameter [J].
double energy_scale(const solver::Simulation& simulation) {
    const MassProperties& mass = simulation.definition().templates.front().mass_properties;
    const double diameter = equivalent_diameter(mass.volume);
    return mass.mass * simulation.definition().gravity.norm() * diameter;
}

}  // namespace

RestRule::RestRule(const Case& c, const solver::Simulation& simulation)
    : kinetic_limit_(c.time.rest_kinetic_energy), contact_change_(c.time.rest_contact_change), scale_(energy_scale(simulation)) {}

bool RestRule::holds(const solver::Simulation& now, double* memory) {
    double &quiet_since = memory[0], &pairs_then = memory[1];
    const solver::EnergyReport energy = now.energy();
    relative_energy_ = (energy.kinetic_translation + energy.kinetic_rotation) / (static_cast<double>(now.bodies().size()) * scale_);
    if (!(relative_energy_ < kinetic_limit_)) {
        quiet_since = -1.0;
        return false;
    }
    const auto pairs = static_cast<double>(now.contacts().touching_pairs);
    if (quiet_since < 0.0 || std::abs(pairs - pairs_then) > contact_change_ * pairs_then) {
        quiet_since = now.time();
        pairs_then = pairs;
    }
    return now.time() - quiet_since >= rest_time * (1.0 - 1e-9);
}

std::string RestRule::note() const {
    char text[64];
    std::snprintf(text, sizeof text, "kinetic energy %.1e m g d a pellet", relative_energy_);
    return text;
}

}  // namespace pelletlab::packing
