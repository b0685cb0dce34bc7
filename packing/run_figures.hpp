// Figures of a run that poses and velocities do not tell: contacts and wall loads, read from the simulation itself.
#pragma once

#include "core/observables.hpp"
#include "packing/stage.hpp"

namespace pelletlab::packing {

/// Appends «largest_overlap_ratio» (over all watch times of the run), «time_step_of_limit» at that overlap and «time_step_of_rayleigh», and, of the present
/// instant, «touching_neighbours», «sphere_contacts_per_pellet» and «wall_contacts_per_pellet»: methods run.* in docs/observables.md.
void add_contact_figures(Observables& observables, const solver::Simulation& simulation, const RunMeter& meter);

/// Weight that a wall carries at present, force on it along gravity / weight of all pellets; NaN without gravity or without a wall of that name.
double load_share(const solver::Simulation& simulation, const std::string& wall);

}  // namespace pelletlab::packing
