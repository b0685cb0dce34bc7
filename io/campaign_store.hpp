// campaign.sqlite: one row a run of a campaign, shared by all processes that work on it (SQLite in WAL mode, short transactions).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/observables.hpp"

namespace pelletlab::io {

enum class RunState { planned, running, finished, failed };

struct StoredRun {
    int number = 0;   ///< from 1, in the design's order
    std::string key;  ///< hash of everything that decides the result; equal keys are the same run
    std::string rig;
    std::vector<double> parameters, effects;
    std::uint64_t seed = 1;
    RunState state = RunState::planned;
    std::string worker;       ///< of the process that runs it or ran it
    double seconds = 0.0;     ///< of wall time
    std::string message;      ///< why it failed
    std::string observables;  ///< text of observables.json; empty unless finished
};

class CampaignStore {
public:
    /// Opens the file, or makes it. Throws Error(bad_input) for a file that is no store, one of another version, and one that cannot be written.
    explicit CampaignStore(const std::filesystem::path& file);
    ~CampaignStore();
    CampaignStore(const CampaignStore&) = delete;
    CampaignStore& operator=(const CampaignStore&) = delete;

    /// The design: runs whose key the store has already keep their results; runs that are no longer in the design stay but are not listed.
    void set_design(const std::vector<StoredRun>& runs);
    /// Runs of the design in its order.
    std::vector<StoredRun> runs() const;
    /// Counts of planned, running, finished and failed runs of the design.
    std::vector<int> counts() const;

    /// Takes the first planned run of the design for `worker`; false when there is none.
    bool claim(const std::string& worker, StoredRun& run);
    void finish(const std::string& key, double seconds, const std::string& observables_text);
    void fail(const std::string& key, double seconds, const std::string& message);
    /// Gives a claimed run back.
    void release(const std::string& key);
    /// Workers that hold a run.
    std::vector<std::string> busy_workers() const;
    void release_runs_of(const std::string& worker);
    /// Failed runs become planned again; returns how many.
    int retry_failed();

private:
    struct Database;
    std::unique_ptr<Database> database_;
};

}  // namespace pelletlab::io
