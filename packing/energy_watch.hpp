// Looks out for energy from nowhere while a run goes on: the sign that the time step is too long for the contacts that occur.
#pragma once

#include "solver/simulation.hpp"

namespace pelletlab::packing {

/// Kinetic and potential energy of gravity may only rise by what walls and body forces put in (contacts store and dissipate). The watch allows for what
/// springs give back: as much again as the most kinetic energy seen so far, and m g d of every pellet.
class EnergyWatch {
public:
    explicit EnergyWatch(const solver::Simulation& simulation);
    /// Throws Error(numerical) when energy has appeared, or when spheres have passed through each other (overlap / radius of 1 or more).
    void look(const solver::Simulation& simulation, double largest_overlap_ratio);

private:
    double start_ = 0.0, slack_ = 0.0, most_kinetic_ = 0.0;  ///< [J]
};

}  // namespace pelletlab::packing
