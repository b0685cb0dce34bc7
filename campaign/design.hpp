// The design of a campaign: space-filling base points, one block an effect, and repeats with other seeds.
#pragma once

#include "core/campaign_plan.hpp"

namespace pelletlab::campaign {

/// Point i (from 0) of Sobol's sequence in (0, 1)^dimensions, its corner point left out (Joe & Kuo 2008, as in Boost). Every beginning of it fills the cube
/// evenly, so a campaign can be made longer without losing what was run.
Eigen::VectorXd sobol_point(int i, int dimensions);

/// All runs: every configuration in every rig. Base points and repeats have all effects at their baseline; the block of an effect has its own points and
/// amplitudes θ in [0.15, 1] (alternating in sign when two-sided), all others at their baseline. A run's seed depends on its place in the design and on the
/// plan's seed alone; the rigs of one configuration share it.
std::vector<PlannedRun> design_of(const CampaignPlan& plan);

/// The design's values of one run as overrides of its case: «contacts.pellet-pellet.sliding_friction=0.4», «seed=17».
std::vector<std::string> overrides_of(const CampaignPlan& plan, const PlannedRun& run);

}  // namespace pelletlab::campaign
