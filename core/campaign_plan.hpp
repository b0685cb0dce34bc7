// A campaign to be run with our own rigs: which cases, what is varied, over which design. Made into a table of runs (core/campaign.hpp) by running it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign.hpp"

namespace pelletlab {

/// One rig in one state; its name is the regime in the table of runs.
struct PlannedRig {
    std::string name;
    std::string case_file;               ///< relative to the plan's folder
    std::vector<std::string> overrides;  ///< «key=value» over the case
    Place place;
};

struct PlannedObservable {
    std::string name;  ///< as in observables.json; a profile gives one column a bin
    double tolerance = 0.0;
    double axis_lower = 0.0, axis_upper = 0.0;  ///< of a profile, in its axis unit; equal: all bins that every good run has
};

/// What an effect of the plan changes.
enum class PlannedEffectKind {
    case_keys,     ///< the keys that the plan names
    library_case,  ///< the case, by an effect of the library (experiments/effects)
    library_data   ///< what was measured in a run, by an effect of the library: no run of its own
};

struct CampaignPlan {
    std::string name, file, text_sha256;
    std::uint64_t seed = 1;
    std::vector<PlannedRig> rigs;
    std::vector<CampaignParameter> parameters;
    std::vector<std::vector<std::string>> parameter_keys;  ///< case keys that take the parameter's value
    std::vector<CampaignEffect> effects;
    std::vector<std::vector<std::string>> effect_keys;  ///< empty for effects of the library
    std::vector<PlannedEffectKind> effect_kinds;
    std::vector<std::vector<double>> effect_levels;  ///< the only values that it can have besides the baseline; empty: all
    std::vector<Place> effect_places;
    std::vector<PlannedObservable> observables;
    std::vector<std::string> good{"complete"};  ///< statuses of runs that count
    double largest_failed_share = 0.05;
    // The design: base points, runs of each effect, and points that are repeated with other seeds.
    int points = 0;  ///< 0: ten a parameter
    int runs_an_effect = 14;
    int anchors = 6, repeats = 3;  ///< the first `anchors` points are run `repeats` times in all
};

/// One run of the design in one rig.
struct PlannedRun {
    int rig = 0;
    std::vector<double> parameters, effects;  ///< values in the units of the plan
    std::uint64_t seed = 1;
};

/// Values of one base point as an instrument with an effect of the measurement would have seen them.
struct PlannedReading {
    int point = 0;                ///< base point of the design, from 0
    std::vector<double> effects;  ///< values in the units of the plan
};

}  // namespace pelletlab
