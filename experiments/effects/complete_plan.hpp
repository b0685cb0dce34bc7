// Effects that a campaign's plan only names, filled in from the library.
#pragma once

#include "core/campaign_plan.hpp"

namespace pelletlab::experiments {

/// Effects of the plan without keys get title, unit, class, range and levels from the library; a range (`full`) and a title that the plan states stay. Throws
/// Error(bad_input) at the place in the plan for an unknown name and for a range that cuts off all levels.
void complete_effects(CampaignPlan& plan);

}  // namespace pelletlab::experiments
