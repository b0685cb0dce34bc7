// From numbers to exactly one of seven answers.
#pragma once

#include "core/diagnosis.hpp"
#include "diagnosis/attribute.hpp"
#include "diagnosis/recalibrate.hpp"

namespace pelletlab::diagnosis {

struct Judgement {
    Verdict verdict = Verdict::underpowered;
    std::vector<int> named;  ///< library effects, most probable first; empty unless EFFECT, EFFECTS or SET
    std::string reason;
};

struct Evidence {
    const Attribution* attribution = nullptr;
    double transfer_p = not_known;
    double best_detectability = 0.0;       ///< largest λ_k0 at θ = 1 near the baseline's fit
    bool second_effect_confirmed = false;  ///< by runs, not by the emulator
};

/// OUTSIDE-LIBRARY: P(none of these) reaches its threshold and the best explanation is doubtful (adequacy p < 0.2), or the adequacy test refuses it.
/// NO-GAP / AMBIGUOUS-CALIBRATION / UNDERPOWERED: «parameters only» is adequate, no effect reaches the claim threshold, and 1 − P(parameters only) stays below
/// its threshold, as it does in 95 % of cases without effect;
///   ambiguous when data that were calibrated on fit and the rest missed; underpowered when no effect could have reached λ = 9.
/// EFFECT: one effect at or above the claim threshold. EFFECTS: two, the pair better than the best single effect by 3 nats, and confirmed. SET: everything
/// else.
Judgement judge(const std::vector<Hypothesis>& hypotheses, const Evidence& evidence, const Thresholds& thresholds);

}  // namespace pelletlab::diagnosis
