// How large a time step may be, from the spheres, the materials and the number of contacts that a clump can have at once.
#pragma once

#include <string>

#include "solver/simulation.hpp"

namespace pelletlab::solver {

struct TimeStepAdvice {
    /// Rayleigh step of the smallest sphere, π r sqrt(ρ/G) / (0.1631 ν + 0.8766) [s]; smallest over the templates.
    double rayleigh = 0.0;
    /// 2 / ω_max [s], the stability limit of velocity Verlet, with ω_max from the summed stiffness of all spheres that one face of a clump can press at
    /// once, on two opposite sides, against a partner that moves (mass, moments of inertia and tangential stiffness included).
    double contact_limit = 0.0;
    /// Overlap / radius of the smallest sphere for which contact_limit holds; it falls with overlap^(1/4).
    double assumed_overlap_ratio = 0.0;
    std::string limited_by;  ///< template and partner that give contact_limit

    double percent_of_rayleigh(double step) const { return 100.0 * step / rayleigh; }
    double percent_of_limit(double step) const { return 100.0 * step / contact_limit; }
};

/// Advice for a definition. The constructor of Simulation refuses a step above contact_limit.
TimeStepAdvice advise_time_step(const SimulationDefinition& definition);

}  // namespace pelletlab::solver
