// What every rig hands back, and figures of a run that poses and velocities do not tell: contacts and wall loads, read from the simulation itself.
#pragma once

#include "core/observables.hpp"
#include "packing/stage.hpp"

namespace pelletlab::packing {

struct RunResult {
    Observables observables;
    std::uint64_t state_hash = 0;
    std::uint64_t steps = 0;
    double wall_seconds = 0.0;  ///< of stepping alone
    double pellet_steps_per_second = 0.0;
};

/// What was measured, with add_contact_figures and add_energy_book, and how the run went.
RunResult run_result(Observables measured, const solver::Simulation& simulation, const RunMeter& meter);

/// Appends «largest_overlap_ratio» (over all watch times of the run), «time_step_of_limit» at that overlap and «time_step_of_rayleigh», and, of the present
/// instant, «touching_neighbours», «sphere_contacts_per_pellet» and «wall_contacts_per_pellet»: methods run.* in docs/observables.md.
void add_contact_figures(Observables& observables, const solver::Simulation& simulation, const RunMeter& meter);

/// With physics.energy_book: appends energies of the present instant and what walls and forces put in and contacts dissipated since the beginning [mJ]; method
/// run.energy_book in docs/observables.md.
void add_energy_book(Observables& observables, const solver::Simulation& simulation);

/// Weight that a wall carries at present, force on it along gravity / weight of all pellets; NaN without gravity or without a wall of that name.
double load_share(const solver::Simulation& simulation, const std::string& wall);

}  // namespace pelletlab::packing
