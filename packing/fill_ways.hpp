// How pellets come into a vertical tube: as one loose cloud, as rain from a sieve, in batches that settle one after the other, or through a funnel; and taps.
#pragma once

#include <vector>

#include "packing/funnel.hpp"
#include "packing/stage.hpp"

namespace pelletlab::packing {

struct FillPlan {
    double bed = 0.0;                           ///< [m], height that the bed will have at a packing fraction of 0.55: what room is planned with
    double top = 0.0;                           ///< [m], the tube must reach so far
    InsertionRegion region;                     ///< of the first round
    std::vector<std::uint32_t> rounds;          ///< pellets that are released together
    double round_time = 0.0;                    ///< [s] between two rounds of rain; 0: each round comes to rest first
    std::vector<solver::WallDefinition> walls;  ///< besides the tube's: funnel and shutter
    double outlet = 0.0;                        ///< [m], of the funnel
};

/// Throws Error(bad_input) when the tube, the sieve or the funnel has no room for it.
FillPlan plan_fill(const Case& c, const RigidTemplate& pellet);

/// Adds the pellets of one round: the first before the run begins, the others in fill(). Throws Error(bad_input) when rain finds a pellet in the sieve.
void add_round(solver::Simulation& simulation, const Case& c, const FillPlan& plan, std::size_t round);

/// Everything from the first round to rest. A fill that does not come to rest is a result with that status.
SettleStatus fill(Course& course, solver::Simulation& simulation, const Case& c, const FillPlan& plan);

/// insertion.taps taps of the tube, standing or lying (not of the funnel): each lifts its walls once by ½ A (1 − cos 2π f t) and lets the bed come to rest.
/// `status` is that before.
SettleStatus tap(Course& course, solver::Simulation& simulation, const Case& c, SettleStatus status);

}  // namespace pelletlab::packing
