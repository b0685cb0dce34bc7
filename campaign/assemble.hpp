// From rows as read to configurations as the statistics use them: regimes joined, amplitudes scaled, failed runs counted, contradictions refused.
#pragma once

#include "core/campaign.hpp"
#include "core/experiment.hpp"

namespace pelletlab::campaign {

/// Joins the rows of one configuration (equal parameters and amplitudes) over its regimes. A configuration that lacks a regime, a value, or whose status
/// is bad in any regime is left out and its bad runs are counted in its block (the set of effects switched on).
/// Throws Error(bad_input) when a block of runs within |θ| ≤ 1 has more than `largest_failed_share` of unusable runs, when a parameter or effect never
/// changes, or when no run has all effects at their baseline.
Campaign assemble(CampaignTable table);

/// Scaled amplitude θ of an effect's value, and back.
double scaled_amplitude(const CampaignEffect& effect, double value);
double value_of_amplitude(const CampaignEffect& effect, double theta);

/// φ in [0, 1] of a parameter's value, and back. Values outside the range give φ outside [0, 1].
double unit_coordinate(const CampaignParameter& parameter, double value);
double value_of_coordinate(const CampaignParameter& parameter, double phi);

/// The campaign without the configurations at these points (parameter name → value): how runs that a case was drawn from are kept out. Throws Error(bad_input)
/// for an unknown parameter name or a point that no configuration has.
Campaign without_points(const Campaign& campaign, const std::vector<std::vector<std::pair<std::string, double>>>& points, const std::string& file);

/// Configurations whose switched-on effects all are in `effects` (indices), in the campaign's order.
std::vector<int> configurations_with(const Campaign& campaign, const std::vector<int>& effects, int largest_count_of_effects);

/// The subset as a campaign of its own.
Campaign subset(const Campaign& campaign, const std::vector<int>& configurations);

}  // namespace pelletlab::campaign
