// What every rig hands back, and figures of a run that poses and velocities do not tell: contacts and wall loads, read from the simulation itself.
#pragma once

#include <string>
#include <vector>

#include "core/observables.hpp"
#include "packing/stage.hpp"

namespace pelletlab::packing {

struct BookLine {
    std::string name;
    double value = 0.0;  ///< [mJ]
};

struct RunResult {
    Observables observables;
    std::uint64_t state_hash = 0;
    std::uint64_t steps = 0;
    double wall_seconds = 0.0;  ///< of stepping alone
    double pellet_steps_per_second = 0.0;
    std::vector<BookLine> energy_book;  ///< empty without physics.energy_book
};

/// What was measured, with add_contact_figures, and how the run went.
RunResult run_result(Observables measured, const solver::Simulation& simulation, const RunMeter& meter);

/// Appends «largest_overlap_ratio» (over all watch times of the run), «time_step_of_limit» at that overlap and «time_step_of_rayleigh», and, of the present
/// instant, «touching_neighbours», «sphere_contacts_per_pellet» and «wall_contacts_per_pellet»: methods run.* in docs/observables.md.
void add_contact_figures(Observables& observables, const solver::Simulation& simulation, const RunMeter& meter);

/// With physics.energy_book: energies of the present instant and what walls and forces put in and contacts dissipated since the beginning; see «The energy
/// book» in docs/observables.md. Sums of all contacts in the order in which the solver has them: their last digits may differ after a restart.
std::vector<BookLine> energy_book(const solver::Simulation& simulation);

/// Weight that a wall carries at present, force on it along gravity / weight of all pellets; NaN without gravity or without a wall of that name.
double load_share(const solver::Simulation& simulation, const std::string& wall);

}  // namespace pelletlab::packing
