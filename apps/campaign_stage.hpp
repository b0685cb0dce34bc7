// A campaign of our own runs: a plan becomes a store with one row a run, workers take rows until none is left, and the store becomes a table of runs.
#pragma once

#include <filesystem>
#include <string>

#include "core/campaign_plan.hpp"
#include "io/campaign_store.hpp"

namespace pelletlab::apps {

struct CampaignRequest {
    std::filesystem::path plan_file, folder;  ///< folder: campaign.sqlite, runs/, workers/, and the table when it is done; empty: out/<name of the plan>
    int jobs = 1;
    bool retry_failed = false, keep_runs = false;
    std::string launcher = "local";  ///< «local», «slurm», «parallel»
};

struct OpenedCampaign {
    CampaignPlan plan;
    std::filesystem::path folder;
};

/// <folder>/campaign.sqlite
std::filesystem::path store_file(const std::filesystem::path& folder);

/// Reads the plan and puts its design into the store. Every case of the design is read first, so that what is wrong with a key or a clump is said before
/// anything runs. Runs whose worker has died are given back.
OpenedCampaign open_campaign(const CampaignRequest& request);

/// One worker: runs after runs until none is planned any more. Ctrl-C gives the present run back; its checkpoint stays.
void work_on_campaign(const OpenedCampaign& campaign, bool keep_runs);

/// The whole: workers side by side (or the job files of a cluster), progress with time left, and the table at the end.
void run_campaign(const CampaignRequest& request);

/// campaign.toml and runs.csv in the folder: what `diagnose` and `calibrate` read. Throws Error(bad_input) when an observable is in no finished run.
void export_campaign(const OpenedCampaign& campaign);

}  // namespace pelletlab::apps
