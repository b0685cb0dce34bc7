// Stages 2 and 3 of the chain: case file + clump template → trajectory, observables, ParaView files and pictures in one folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace pelletlab::apps {

/// What to do with the checkpoint that an interrupted run of the same case left.
enum class Resume {
    refuse,      ///< say that it is there: it may be worth hours
    yes,         ///< go on from it; that of another case is an error; begin at the beginning when there is none
    if_possible  ///< the same, but begin at the beginning when it belongs to another case
};

struct RunRequest {
    std::filesystem::path case_file;
    std::vector<std::string> overrides;  ///< «key=value»
    std::filesystem::path output;        ///< empty: out/<case name>
    bool force = false;
    Resume resume = Resume::refuse;
    std::vector<std::string> effects = {};  ///< «name=amplitude» of the library (experiments/effects), after the overrides
    double checkpoint_interval = 60.0;      ///< [s] of wall time; 0: none but that of Ctrl-C
};

struct RunSummary {
    std::filesystem::path folder;
    std::string status;
    bool was_up_to_date = false;
    std::uint64_t state_hash = 0;
    double wall_seconds = 0.0;             ///< whole stage
    double pellet_steps_per_second = 0.0;  ///< stepping alone
};

/// Hash of what decides a run's result: version of the program, resolved case, clump and meshes. Not the commit, unlike a stage's fingerprint: a campaign of
/// hours outlives commits. Throws Error(bad_input) for files that are not there.
std::string run_key(const Case& c);

/// The case as the file, the overrides and the effects make it, checked as a whole.
Case case_with_effects(const std::filesystem::path& file, const std::vector<std::string>& overrides, const std::vector<std::string>& effects);

/// Runs the case on its rig; throws Error(usage) when the case's rig is not `expected`.
RunSummary run_case(const RunRequest& request, Rig expected);

}  // namespace pelletlab::apps
