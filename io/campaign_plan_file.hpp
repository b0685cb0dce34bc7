// plan.toml: a campaign to be run with our own rigs. All keys: docs/campaigns.md.
#pragma once

#include <filesystem>

#include "core/campaign_plan.hpp"

namespace pelletlab::io {

/// Strict: every mistake with file, line and column. Whether the case files take the keys is found out by the one who reads them. An effect without keys is one
/// of the library: its kind is library_case for now, unit and class are empty, `full` is NaN unless the plan states it; experiments::complete_effects fills
/// them in.
CampaignPlan read_campaign_plan(const std::filesystem::path& file);

}  // namespace pelletlab::io
