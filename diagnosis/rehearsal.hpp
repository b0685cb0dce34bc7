// Cases whose cause is known before any measured value is looked at: the thresholds of a diagnosis are set on them. Simulated ones are as the emulator
// believes; runs of the campaign, judged by an emulator that never saw their point, are as it errs.
#pragma once

#include "core/progress.hpp"
#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

struct RehearsedCase {
    std::size_t truth = 0;  ///< index of the hypothesis
    bool is_run = false;
    Attribution attribution;  ///< at temperature 1, without its fits
};

/// `count` cases drawn from the campaign's prior: parameters only 40 %, one effect 45 %, two effects 15 %; φ uniform, θ from its prior; noise from Σ.
std::vector<RehearsedCase> simulated_cases(const Attributor& attributor, int count, std::uint64_t seed, const ProgressSink& progress = {});

/// Up to `count` runs of the campaign inside the parameters' ranges, drawn without replacement in the same shares as far as there are such runs. The runs at a
/// case's point are all kept out, kernel and error model stay; the noise of the measurement is added, and the run's own scatter is part of Σ.
std::vector<RehearsedCase> left_out_cases(const Attributor& attributor, int count, std::uint64_t seed, const ProgressSink& progress = {});

}  // namespace pelletlab::diagnosis
