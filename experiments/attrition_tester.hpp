// Attrition tester (ASTM D4058): a drum with one baffle lifts pellets and drops them. What the pellets do against the baffle's angle, and what collisions cost.
#pragma once

#include "packing/fill_tube.hpp"
#include "solver/contact_events.hpp"

namespace pelletlab::experiments {

/// The case's rig must be `tester`; otherwise as packing::fill_tube. Stages: settling (drum at rest, baffle at tester.baffle_start), spinning up, measuring
/// over time.measure cut to whole turns. The energy book is kept whatever physics.energy_book says, because the energies of collisions come from it.
packing::RunResult run_tester(const Case& c, const packing::RunInputs& inputs, const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink,
                              const ProgressSink& progress, const packing::RunKeeping& keeping = {});

/// Collision rates, dissipation and spectra of one kind of contact, from its records at the end of each turn (the first record is that at the beginning).
/// Appends values and profiles named «…_<kind>»: methods tester.collisions and tester.spectrum in docs/observables.md.
void add_collisions(Observables& observables, const std::string& kind, const std::vector<solver::ContactEvents>& after_turns, double turn_time,
                    std::size_t pellets, const TimeWindow& window);

}  // namespace pelletlab::experiments
