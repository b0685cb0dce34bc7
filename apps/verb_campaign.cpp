// pelletlab campaign run | work | status | export
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "apps/campaign_stage.hpp"
#include "apps/terminal.hpp"
#include "apps/verbs.hpp"

namespace pelletlab::apps {

namespace {

void print_status(const CampaignRequest& request) {
    const OpenedCampaign campaign = open_campaign(request);
    const io::CampaignStore store(store_file(campaign.folder));
    const auto counts = store.counts();
    print_pairs({{"finished", std::to_string(counts[2])},
                 {"at work", std::to_string(counts[1])},
                 {"to be run", std::to_string(counts[0])},
                 {"failed", std::to_string(counts[3])}});
    for (const io::StoredRun& run : store.runs())
        if (run.state == io::RunState::failed) print_line(fmt::format("  run {} ({}): {}", run.number, run.rig, run.message));
}

}  // namespace

void add_campaign_verb(CLI::App& app) {
    CLI::App* group = app.add_subcommand("campaign", "Run many cases over a design of parameters and effects, and make one table of them");
    group->require_subcommand(1);
    group->fallthrough();
    auto request = std::make_shared<CampaignRequest>();
    const auto add = [&](const char* name, const char* help) {
        CLI::App* verb = group->add_subcommand(name, help);
        verb->add_option("plan", request->plan_file, "plan.toml: rigs, parameters, effects, observables, design (docs/campaigns.md)")->required();
        verb->add_option("-o,--output", request->folder, "Folder of the campaign; out/<name of the plan> when not given");
        return verb;
    };
    CLI::App* run = add("run",
                        "Run what is not yet finished, then write the table. Interrupted or killed, the same command goes on\n"
                        "  example: pelletlab campaign run examples/campaign/plan.toml -o out/campaign --jobs 2");
    run->add_option("-j,--jobs", request->jobs, "Runs side by side, one thread each")->check(CLI::Range(1, 1024))->capture_default_str();
    run->add_option("--launcher", request->launcher, "local: workers on this machine; slurm: write array.sbatch; parallel: write jobs.txt for GNU parallel")
        ->check(CLI::IsMember({"local", "slurm", "parallel"}))
        ->capture_default_str();
    run->add_flag("--retry-failed", request->retry_failed, "Run failed ones again");
    run->add_flag("--keep-runs", request->keep_runs, "Keep the folder of every run (trajectories); else the store keeps what was measured");
    run->callback([request] { run_campaign(*request); });
    CLI::App* work = add("work",
                         "One worker: takes runs until none is left; what a job of a cluster does\n"
                         "  example: pelletlab campaign work examples/campaign/plan.toml -o out/campaign");
    work->add_flag("--keep-runs", request->keep_runs, "Keep the folder of every run");
    work->callback([request] { work_on_campaign(open_campaign(*request), request->keep_runs); });
    add("status", "How far it is, and why runs failed\n  example: pelletlab campaign status examples/campaign/plan.toml -o out/campaign")->callback([request] {
        print_status(*request);
    });
    add("export", "Write the table of what is finished\n  example: pelletlab campaign export examples/campaign/plan.toml -o out/campaign")->callback([request] {
        export_campaign(open_campaign(*request));
    });
}

}  // namespace pelletlab::apps
