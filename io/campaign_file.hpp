// campaign.toml and its table of runs, and experiment.toml with its profiles: strict readers, every mistake with file, line and column.
// All keys: docs/diagnosis.md.
#pragma once

#include <filesystem>

#include "core/campaign.hpp"
#include "core/experiment.hpp"

namespace pelletlab::io {

/// Reads the description and the table it names (relative to the description's folder).
CampaignTable read_campaign(const std::filesystem::path& file);

/// Reads the experiment and the CSV files it names (relative to its folder); campaign_file comes back as a path that can be opened.
Experiment read_experiment(const std::filesystem::path& file);

}  // namespace pelletlab::io
