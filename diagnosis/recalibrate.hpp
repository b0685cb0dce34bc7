// Thresholds and temperature from cases with a known cause, fixed before any measured value is looked at.
#pragma once

#include <string>

#include "diagnosis/rehearsal.hpp"

namespace pelletlab::diagnosis {

struct Thresholds {
    double temperature = 1.0;  ///< of p^{1/T}, best Brier score of the inclusion probabilities over the cases
    double claim = 0.90;       ///< an effect is named from this inclusion probability on: at least 0.90, and exceeded by ≤ 5 % of the cases without effect
    double gap = 0.5;  ///< a baseline that is adequate stands below this 1 − P(parameters only): exceeded by ≤ 5 % of the cases without effect, 0.5 to 0.95
    double open = 0.5;        ///< «none of these» from this probability on: exceeded by ≤ 2 % of all cases (their cause is in the library), 0.5 to 0.99
    double adequacy = 0.05;   ///< the best explanation is refused below this p value: the 2 % quantile over all cases, 0.01 to 0.05
    int cases = 0, runs = 0;  ///< cases judged; how many of them are runs of the campaign
    double null_false_alarm = 0.0;  ///< share of the cases without effect with any effect at or above `claim`
};

/// Half of the cases are runs of the campaign (fewer when it has fewer), the others simulated. With cases = 0 the values above come back.
Thresholds recalibrate(const Attributor& attributor, int cases, std::uint64_t seed, const ProgressSink& progress = {});

/// The thresholds from cases that have been judged at temperature 1.
Thresholds thresholds_from(std::vector<RehearsedCase> cases, const std::vector<Hypothesis>& hypotheses, Eigen::Index effects);

/// Words that fix the thresholds for a hash.
std::string thresholds_text(const Thresholds& thresholds);

}  // namespace pelletlab::diagnosis
