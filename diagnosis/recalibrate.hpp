// Thresholds and temperature from simulated cases of the campaign's own prior, fixed before any measured value is looked at.
#pragma once

#include <string>

#include "core/progress.hpp"
#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

struct Thresholds {
    double temperature = 1.0;  ///< of p^{1/T}, best log score over the simulated cases
    double claim = 0.90;       ///< an effect is named from this inclusion probability on: at least 0.90, and exceeded by ≤ 5 % of simulated nulls
    double adequacy =
        0.05;  ///< the best explanation is refused below this p value: the 3 % quantile over cases whose explanation is in the library, at most 0.05
    int cases = 0;
    double null_false_alarm = 0.0;  ///< share of simulated nulls with any effect at or above `claim`
};

/// Draws cases (parameters only 40 %, one effect 45 %, two effects 15 %; φ uniform, θ from its prior; noise from Σ), attributes them and sets the thresholds.
/// With cases = 0 the values above come back.
Thresholds recalibrate(const Attributor& attributor, int cases, std::uint64_t seed, const ProgressSink& progress = {});

/// Words that fix the thresholds for a hash.
std::string thresholds_text(const Thresholds& thresholds);

}  // namespace pelletlab::diagnosis
