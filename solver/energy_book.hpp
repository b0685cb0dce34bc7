// Where the energy of a simulation is, where it went, and who put it in.
#pragma once

#include <vector>

namespace pelletlab::solver {

/// All in joule. Kinetic energy, gravity, walls' and body forces' work are always there; the contacts' part is kept only with Physics::energy_book.
///
/// Work is force times velocity at the instants at which forces are computed, times Δt: exact to second order. Dissipation is booked by mechanism from the
/// contact forces themselves, not as what is missing, so imbalance() tests the books.
struct EnergyReport {
    double kinetic_translation = 0.0, kinetic_rotation = 0.0, gravity = 0.0;

    double elastic_normal = 0.0;      ///< stored at present, Hertz's or the linear spring's
    double elastic_tangential = 0.0;  ///< ½ S_t s²
    double elastic_rolling = 0.0;     ///< ½ T²/k_r

    double normal_damping = 0.0;      ///< dissipated since the simulation was made
    double tangential_damping = 0.0;  ///< of contacts that stick
    double sliding = 0.0;
    double rolling = 0.0;
    double fed = 0.0;               ///< put in by contact forces without a potential: cohesion; springs whose stiffness changes while they are loaded
    double body_force_work = 0.0;   ///< drag and the like
    std::vector<double> wall_work;  ///< put in by each wall's motion

    double mechanical() const { return kinetic_translation + kinetic_rotation + gravity + elastic_normal + elastic_tangential + elastic_rolling; }
    double dissipated() const { return normal_damping + tangential_damping + sliding + rolling; }
    double input() const;
    /// mechanical + dissipated − input: constant but for the error of the time step and what bodies had when they were added.
    double total() const { return mechanical() + dissipated() - input(); }
};

}  // namespace pelletlab::solver
