// How large a time step may be, from the spheres, the materials and the number of contacts that a clump can have at once.
#pragma once

#include <string>

#include "solver/simulation.hpp"

namespace pelletlab::solver {

struct TimeStepAdvice {
    /// Rayleigh step of the smallest sphere, π r sqrt(ρ/G) / (0.1631 ν + 0.8766) [s]; smallest over the templates.
    double rayleigh = 0.0;
    /// 2 / ω_max [s], the stability limit of velocity Verlet, with ω_max from the summed stiffness of all spheres that one face of a clump can press at
    /// once, on two opposite sides, against a partner that moves (mass, moments of inertia, tangential and rolling springs included).
    double contact_limit = 0.0;
    /// The same contacts with their damping, whose force lags half a step: the largest Δt for which all eigenvalues of M⁻¹ (K Δt² + 4 C Δt) stay below 4
    /// [s]. Above it a flat contact that presses lightly may rattle; it cannot run away, because the damping falls with the overlap and friction is bounded.
    double damped_limit = 0.0;
    /// Overlap / radius of the smallest sphere for which contact_limit holds: 0.1, and with cohesion so much more as it holds a contact without any load
    /// (JKR: with its own stiffness dF/dδ). The limit falls with overlap^(1/4): see limit_at.
    double assumed_overlap_ratio = 0.0;
    bool hertz = true;       ///< the linear law has the same limit at every overlap
    std::string limited_by;  ///< template and partner that give contact_limit

    /// contact_limit where overlaps are this large: 1 stands for hard compaction.
    double limit_at(double overlap_ratio) const;
    double percent_of_rayleigh(double step) const { return 100.0 * step / rayleigh; }
    double percent_of_limit(double step) const { return 100.0 * step / contact_limit; }
};

/// Advice for a definition. The constructor of Simulation refuses a step above contact_limit.
TimeStepAdvice advise_time_step(const SimulationDefinition& definition);

}  // namespace pelletlab::solver
