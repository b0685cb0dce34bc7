// [[parameter]] and [[effect]] as campaign.toml and plan.toml both have them; `column` is the name.
#pragma once

#include "core/campaign.hpp"
#include "io/detail/toml_table.hpp"

namespace pelletlab::io::detail {

CampaignParameter read_campaign_parameter(TomlTable& t);
CampaignEffect read_campaign_effect(TomlTable& t);

}  // namespace pelletlab::io::detail
