// The design of a campaign: space-filling base points, one block an effect, and repeats with other seeds.
#pragma once

#include "core/campaign_plan.hpp"

namespace pelletlab::campaign {

/// Point i (from 0) of Sobol's sequence in (0, 1)^dimensions, its corner point left out (Joe & Kuo 2008, as in Boost). Every beginning of it fills the cube
/// evenly, so a campaign can be made longer without losing what was run.
Eigen::VectorXd sobol_point(int i, int dimensions);

/// All runs: every configuration in every rig. Base points and repeats have all effects at their baseline; the block of an effect has its own points and
/// amplitudes θ in [0.15, 1] (alternating in sign when two-sided; its levels in turn when it has some), all others at their baseline. A run's seed depends on
/// its place in the design and on the plan's seed alone; the rigs of one configuration share it. Effects of the measurement have no runs.
std::vector<PlannedRun> design_of(const CampaignPlan& plan);

/// Readings of the effects of the measurement: the base points in turn, amplitudes as above; `runs_an_effect` an effect, at most one a base point.
std::vector<PlannedReading> readings_of(const CampaignPlan& plan);

/// Configurations without any effect at the beginning of the design.
int base_points(const CampaignPlan& plan);

/// The design's values of one run as overrides of its case: «contacts.pellet-pellet.sliding_friction=0.4», «seed=17».
std::vector<std::string> overrides_of(const CampaignPlan& plan, const PlannedRun& run);

}  // namespace pelletlab::campaign
