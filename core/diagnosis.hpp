// The answers of a diagnosis as plain data: where the gap lies, which effect explains it, how far it shrinks, what to measure next.
#pragma once

#include <string>
#include <vector>

#include "core/observables.hpp"
#include "core/provenance.hpp"

namespace pelletlab {

enum class Verdict { no_gap, ambiguous_calibration, effect, set, effects, outside_library, underpowered };
std::string verdict_code(Verdict verdict);  ///< «NO-GAP», «EFFECT», …

struct AuditItem {
    bool is_warning = false;
    std::string text;
};

/// What the data can see at all, computed before they are judged.
struct DiagnosisPlan {
    struct Effect {
        std::string name;
        double detectability =
            0.0;  ///< λ_k0 at θ = 1: squared distance in standard deviations that no recalibration can remove; median over the parameters' range
        double smallest_detectability = 0.0;  ///< the worst over the range
        double absorbed_share = 0.0;          ///< 1 − λ_k0 / (squared distance without recalibration)
        double detectable_from = 0.0;         ///< amplitude θ at which λ_k0 reaches 9; NaN when θ = 1 does not
        std::string amplitude_text;           ///< the same in the effect's unit
        double expected_error = 0.0;          ///< Σ_l Φ(−√λ_kl / 2), at most 1: bound on the chance to name another effect at θ = 1
    };
    std::vector<Effect> effects;
    std::vector<std::vector<double>> separability;  ///< λ_kl: effect k at θ = 1 against the best that effect l can do
    struct Leverage {
        std::string group;
        double largest = 0.0;  ///< h_jj > 0.8: calibration would hide a gap here
    };
    std::vector<Leverage> leverages;
    struct Direction {
        double deviation = 0.0;  ///< posterior standard deviation over the prior's, 1 means the data say nothing
        std::string text;        ///< «0.9 sliding − 0.4 restitution»
    };
    std::vector<Direction> directions;
    double noise_rms = 0.0;  ///< of one datum, in tolerances
};

struct DiagnosisWhere {
    std::string group, observable, region, regime, unit;
    double gap = 0.0, lower = 0.0, upper = 0.0;  ///< mean of measured − best baseline, 90 % interval [unit]
    double statistic = 0.0, degrees = 0.0, p = 1.0;
    bool discovery = false;                                                ///< by the group's own data
    double left_out_z = 0.0;                                               ///< standardised miss of the group's mean when the fit does not see the group
    double explained = 0.0, explained_lower = 0.0, explained_upper = 0.0;  ///< the gap that the weighed explanations predict here, 90 % interval [unit]
    double explained_probability = 0.0;                                    ///< that it is a gap: Σ (gap/σ)² > 1 over the group
    bool explained_discovery = false;                                      ///< by the explanation, which all data speak for
};

struct DiagnosisHypothesis {
    std::string name;
    double log_evidence = 0.0, prior = 0.0, probability = 0.0, chi2 = 0.0, effective_samples = 0.0;
    bool in_set = false;
    struct Amplitude {
        std::string effect;
        double mean = 0.0, lower = 0.0, upper = 0.0;  ///< θ
        std::string text;                             ///< in the effect's unit
    };
    std::vector<Amplitude> amplitudes;
    std::vector<std::string> parameters;  ///< «sliding 0.42 (0.31 to 0.55)»
};

struct DiagnosisCurve {
    std::string name, observable, regime, unit, axis_name;
    bool held_out = false;
    std::vector<double> axis, value, uncertainty, baseline, explained;
};

/// Root mean square miss in tolerances, noise removed, before (parameters only) and after (leading explanation), both fitted to the same data.
struct DiagnosisShrink {
    std::string data;  ///< «fitted», «held out», or one measurement
    double before = 0.0, after = 0.0, placebo = 0.0, floor = 0.0;
    double shrink = 0.0, lower = 0.0, upper = 0.0;  ///< 1 − after/before with 90 % interval
};

struct DiagnosisNext {
    std::string name;
    double cost = 0.0, information = 0.0, per_cost = 0.0;  ///< nats
};

struct Diagnosis {
    std::string name, campaign, campaign_source;
    Verdict verdict = Verdict::underpowered;
    std::string statement;           ///< one or two sentences for people
    std::vector<std::string> named;  ///< effects of the verdict
    std::vector<std::string> notes;
    std::vector<AuditItem> audit;
    DiagnosisPlan plan;
    std::vector<DiagnosisWhere> where;
    std::vector<DiagnosisHypothesis> hypotheses;
    struct Inclusion {
        std::string effect;
        double probability = 0.0;
    };
    std::vector<Inclusion> inclusion;
    double temperature = 1.0, claim_threshold = 0.9, adequacy_threshold = 0.05;
    double gap_threshold = 0.5, open_threshold = 0.5;  ///< of 1 − P(parameters only), of P(none of these)
    double baseline_p = 1.0, best_p = 1.0;             ///< adequacy
    std::string best_name, misfit_family;
    std::vector<std::string> nearest;  ///< library signatures closest to what is left, with cosine
    double transfer_p = not_known;     ///< of the miss of data that were not calibrated on; NaN when nothing is marked as calibration
    bool prior_dependent = false;
    std::vector<DiagnosisShrink> how_far;
    std::string confirmation;
    std::vector<DiagnosisNext> next;
    std::vector<DiagnosisCurve> curves;
    std::vector<std::string> emulator;  ///< acceptance, line by line
    bool emulator_accepted = true;
    Provenance provenance;
};

inline std::string verdict_code(Verdict verdict) {
    switch (verdict) {
        case Verdict::no_gap:
            return "NO-GAP";
        case Verdict::ambiguous_calibration:
            return "AMBIGUOUS-CALIBRATION";
        case Verdict::effect:
            return "EFFECT";
        case Verdict::set:
            return "SET";
        case Verdict::effects:
            return "EFFECTS";
        case Verdict::outside_library:
            return "OUTSIDE-LIBRARY";
        case Verdict::underpowered:
            break;
    }
    return "UNDERPOWERED";
}

}  // namespace pelletlab
