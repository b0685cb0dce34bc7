// Blind cases drawn from a campaign itself: a run plays the reality, its point of the parameter space (with all neighbours there) never trains the emulator.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/diagnosis.hpp"
#include "diagnosis/diagnose.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

/// What is sealed.
struct BlindLabel {
    std::string id, kind;  ///< kind: «null», «single», «pair», «outside», «reduced» (library reduced, truth in it)
    int configuration = 0;
    std::vector<std::string> effects;  ///< switched on in truth
    std::vector<double> amplitude;     ///< θ of each
    double detectability = 0.0;        ///< λ of the truth against «parameters only»
    double separability =
        0.0;  ///< smallest λ against any other single effect (for pairs: any single effect; outside the library: all that is left in it, pairs too)
    std::vector<std::string> regions;  ///< groups with a squared projected shift above 9, largest first
    std::vector<std::string> silent;   ///< groups with a squared projected shift below 1
};

/// What everybody sees.
struct BlindCase {
    BlindLabel label;
    std::vector<std::string> library;
    std::vector<std::vector<std::pair<std::string, double>>> exclude;
};

struct BlindCounts {
    int null = 20, single = 40, pair = 15, outside = 15, reduced = 10;
};

/// Cases in shuffled order with their labels; `taken` are configurations that another set has used already. Throws Error(bad_input) when the campaign has too
/// few runs.
std::vector<BlindCase> draw_blind_cases(const Campaign& campaign, const BlindCounts& counts, std::uint64_t seed, const std::vector<int>& taken);

/// The experiment of a case: one measurement a regime and observable, values of the run, settings of the template.
Experiment blind_experiment(const Campaign& campaign, const Experiment& settings_from, const BlindCase& one);

/// Fills λ and regions of a label with the full library's model of its fold.
void measure_label(BlindLabel& label, const Campaign& campaign, const Attributor& attributor);

struct BlindVerdict {
    std::string id, verdict;
    std::vector<std::string> named, discoveries;    ///< discoveries: groups found by their own data or by the explanation
    std::vector<std::string> measured_discoveries;  ///< … by their own data
    std::map<std::string, double> inclusion;
    double probability_of_open = 0.0, probability_of_none = 0.0, best_p = 1.0;
    double pair_gain = 0.0;                                 ///< ln evidence of the most probable pair above the best single effect
    bool pair_confirmed = false;                            ///< by runs
    std::vector<std::string> credible_set;                  ///< hypothesis names
    std::map<std::string, std::vector<std::string>> rules;  ///< baseline rule → effects ranked
};

/// Verdict on one case with frozen thresholds, baselines included.
BlindVerdict blind_verdict(const Problem& problem, const Thresholds& thresholds);

struct BlindScoreRow {
    std::string quantity, bar, result;
    bool reached = false, judged = true;
};
struct BlindScore {
    std::vector<BlindScoreRow> rows;
    std::vector<std::pair<std::string, inference::Share>> rules;               ///< effect ranked first, single effects of the bar region
    std::vector<std::pair<std::string, inference::Share>> rules_all;           ///< … all single effects
    std::vector<std::pair<std::string, std::map<std::string, int>>> verdicts;  ///< kind → verdict → count
};
BlindScore score_blind(const std::vector<BlindLabel>& labels, const std::vector<BlindVerdict>& verdicts);

}  // namespace pelletlab::diagnosis
