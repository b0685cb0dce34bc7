#include "apps/campaign_stage.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "apps/run_stage.hpp"
#include "apps/terminal.hpp"
#include "campaign/design.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "experiments/effects/complete_plan.hpp"
#include "io/campaign_plan_file.hpp"
#include "io/case_file.hpp"
#include "io/files.hpp"

extern char** environ;

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

fs::path lock_file(const fs::path& folder, const std::string& worker) {
    return folder / "workers" / (worker + ".lock");
}

const PlannedRig& rig_of(const CampaignPlan& plan, const std::string& name) {
    return *std::find_if(plan.rigs.begin(), plan.rigs.end(), [&](const PlannedRig& r) { return r.name == name; });
}

fs::path case_of(const CampaignPlan& plan, const PlannedRig& rig) {
    return fs::path(plan.file).parent_path() / rig.case_file;
}

std::vector<std::string> all_overrides(const CampaignPlan& plan, const PlannedRig& rig, const PlannedRun& run) {
    std::vector<std::string> list = rig.overrides;
    for (const std::string& one : campaign::overrides_of(plan, run)) list.push_back(one);
    list.insert(list.end(), {"output.pictures=false", "output.paraview=false"});
    return list;
}

/// Effects of the library that are switched on in a run, for case_with_effects.
std::vector<std::string> effects_of(const CampaignPlan& plan, const PlannedRun& run) {
    std::vector<std::string> list;
    for (std::size_t k = 0; k < plan.effects.size(); ++k)
        if (plan.effect_kinds[k] == PlannedEffectKind::library_case && run.effects[k] != plan.effects[k].baseline)
            list.push_back(fmt::format("{}={:.17g}", plan.effects[k].name, run.effects[k]));
    return list;
}

/// The lock that a worker holds as long as it lives: the kernel takes it away from a killed one.
class WorkerLock {
public:
    explicit WorkerLock(const fs::path& file) : file_(file), handle_(::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
        if (handle_ < 0)
            throw bad_input("cannot write '" + file.string() + "': " + std::strerror(errno), "check the folder's rights and space", {file.string()});
        held_ = ::flock(handle_, LOCK_EX | LOCK_NB) == 0;
    }
    ~WorkerLock() {
        if (held_) fs::remove(file_);
        ::close(handle_);
    }
    WorkerLock(const WorkerLock&) = delete;
    WorkerLock& operator=(const WorkerLock&) = delete;
    bool held() const { return held_; }

private:
    fs::path file_;
    int handle_;
    bool held_ = false;
};

void release_runs_of_the_dead(io::CampaignStore& store, const fs::path& folder) {
    for (const std::string& worker : store.busy_workers()) {
        const WorkerLock lock(lock_file(folder, worker));
        if (lock.held()) store.release_runs_of(worker);
    }
}

std::string own_name() {
    char host[256] = "";
    ::gethostname(host, sizeof host - 1);
    return fmt::format("{}-{}", host, ::getpid());
}

/// Starts this program again with other arguments, its messages in a file.
pid_t start_worker(const std::vector<std::string>& arguments, const fs::path& log) {
    std::vector<char*> argv;
    for (const std::string& one : arguments) argv.push_back(const_cast<char*>(one.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0644);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    pid_t process = 0;
    const int failed = posix_spawn(&process, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw bad_input(std::string("cannot start a worker: ") + std::strerror(failed), "are too many processes running?");
    return process;
}

std::vector<std::string> worker_arguments(const OpenedCampaign& campaign, bool keep_runs) {
    std::vector<std::string> list{"pelletlab", "--threads", "1", "campaign", "work", campaign.plan.file, "-o", campaign.folder.string()};
    if (keep_runs) list.emplace_back("--keep-runs");
    return list;
}

void run_pool(const OpenedCampaign& campaign, const CampaignRequest& request) {
    io::CampaignStore store(store_file(campaign.folder));
    std::vector<pid_t> workers;
    for (int i = 0; i < request.jobs; ++i)
        workers.push_back(start_worker(worker_arguments(campaign, request.keep_runs), campaign.folder / "workers" / fmt::format("worker-{}.log", i + 1)));
    ProgressPrinter printer;
    const ProgressSink progress = printer.sink();
    bool failed = false;
    constexpr int looks_of_grace = 6;
    int looks_since_interrupt = 0;
    while (!workers.empty()) {
        const auto counts = store.counts();
        const int total = counts[0] + counts[1] + counts[2] + counts[3];
        progress({"runs", static_cast<double>(counts[2] + counts[3]), static_cast<double>(total), "runs", 0.0, "",
                  fmt::format("{} at work{}", counts[1], counts[3] > 0 ? fmt::format(", {} failed", counts[3]) : "")});
        // Ctrl-C of a terminal reaches the workers too, and a second signal would end them before they have kept their place: only who is still there later has
        // not heard.
        if (interrupt_requested() && ++looks_since_interrupt == looks_of_grace)
            for (const pid_t worker : workers) ::kill(worker, SIGINT);
        ::usleep(500000);
        for (auto at = workers.begin(); at != workers.end();) {
            int status = 0;
            if (::waitpid(*at, &status, WNOHANG) == 0) {
                ++at;
                continue;
            }
            failed = failed || !WIFEXITED(status) || WEXITSTATUS(status) != 0;
            at = workers.erase(at);
        }
    }
    printer.finish();
    throw_if_interrupted();
    if (failed)
        throw bad_input("a worker ended before the work was done", "see workers/worker-*.log in " + campaign.folder.string() + "; finished runs are kept");
}

/// Job files for others to start: an array whose tasks all do the same, take runs until none is left.
void write_jobs(const OpenedCampaign& campaign, const CampaignRequest& request) {
    const fs::path self = fs::read_symlink("/proc/self/exe"), plan = fs::absolute(campaign.plan.file), folder = fs::absolute(campaign.folder);
    const std::string command =
        fmt::format("'{}' --threads 1 campaign work '{}' -o '{}'{}", self.string(), plan.string(), folder.string(), request.keep_runs ? " --keep-runs" : "");
    if (request.launcher == "slurm") {
        io::write_text(
            folder / "array.sbatch",
            fmt::format("#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --cpus-per-task=1\n#SBATCH --output={}/workers/slurm-%A_%a.log\n{}\n",
                        campaign.plan.name, request.jobs, folder.string(), command));
        print_written(folder / "array.sbatch", "start it with: sbatch " + (folder / "array.sbatch").string());
    } else {
        std::string lines;
        for (int i = 0; i < request.jobs; ++i) lines += command + "\n";
        io::write_text(folder / "jobs.txt", lines);
        print_written(folder / "jobs.txt", fmt::format("start it with: parallel -j {} < {}", request.jobs, (folder / "jobs.txt").string()));
    }
    print_line("  then make the table: pelletlab campaign export " + campaign.plan.file + " -o " + campaign.folder.string());
}

}  // namespace

fs::path store_file(const fs::path& folder) {
    return folder / "campaign.sqlite";
}

OpenedCampaign open_campaign(const CampaignRequest& request) {
    OpenedCampaign campaign{io::read_campaign_plan(request.plan_file), request.folder};
    experiments::complete_effects(campaign.plan);
    const CampaignPlan& plan = campaign.plan;
    if (campaign.folder.empty()) campaign.folder = fs::path("out") / plan.name;
    std::vector<io::StoredRun> runs;
    for (const PlannedRun& run : campaign::design_of(plan)) {
        const PlannedRig& rig = plan.rigs[static_cast<std::size_t>(run.rig)];
        const Case c = case_with_effects(case_of(plan, rig), all_overrides(plan, rig, run), effects_of(plan, run));
        io::StoredRun row;
        row.number = static_cast<int>(runs.size()) + 1;
        row.key = run_key(c);
        row.rig = rig.name;
        row.parameters = run.parameters;
        row.effects = run.effects;
        row.seed = run.seed;
        runs.push_back(row);
    }
    io::prepare_output_folder(campaign.folder / "workers");
    io::CampaignStore store(store_file(campaign.folder));
    store.set_design(runs);
    release_runs_of_the_dead(store, campaign.folder);
    if (request.retry_failed) store.retry_failed();
    return campaign;
}

void work_on_campaign(const OpenedCampaign& campaign, bool keep_runs) {
    const CampaignPlan& plan = campaign.plan;
    io::CampaignStore store(store_file(campaign.folder));
    const std::string name = own_name();
    const WorkerLock lock(lock_file(campaign.folder, name));
    if (!lock.held()) throw bad_input("another process works under the name " + name, "two machines with one name? Give them names of their own");
    io::StoredRun run;
    while (store.claim(name, run)) {
        const Stopwatch stopwatch;
        const PlannedRig& rig = rig_of(plan, run.rig);
        const PlannedRun planned{static_cast<int>(&rig - plan.rigs.data()), run.parameters, run.effects, run.seed};
        const fs::path folder = campaign.folder / "runs" / run.key.substr(0, 16);
        try {
            RunRequest request{case_of(plan, rig), all_overrides(plan, rig, planned), folder, false};
            request.effects = effects_of(plan, planned);
            request.resume = Resume::if_possible;
            run_case(request, io::read_case(request.case_file, request.overrides).rig);
            store.finish(run.key, stopwatch.seconds(), io::read_text(folder / "observables.json"));
            if (!keep_runs) fs::remove_all(folder);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) {
                store.release(run.key);
                throw;
            }
            store.fail(run.key, stopwatch.seconds(), error.what());
        }
        throw_if_interrupted();
    }
}

void run_campaign(const CampaignRequest& request) {
    const Stopwatch stopwatch;
    const OpenedCampaign campaign = open_campaign(request);
    if (request.launcher != "local") return write_jobs(campaign, request);
    {
        const auto counts = io::CampaignStore(store_file(campaign.folder)).counts();
        print_line(
            fmt::format("campaign {}: {} runs, {} of them finished before", campaign.plan.name, counts[0] + counts[1] + counts[2] + counts[3], counts[2]));
        if (counts[0] > 0) run_pool(campaign, request);
    }
    export_campaign(campaign);
    print_line(fmt::format("  took {}", duration_text(stopwatch.seconds())));
}

}  // namespace pelletlab::apps
