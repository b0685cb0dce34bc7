#include "io/diagnosis_file.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files.hpp"

namespace pelletlab {

using Json = nlohmann::json;

// Readers and writers of all members, found by argument-dependent lookup.
NLOHMANN_JSON_SERIALIZE_ENUM(Verdict, {{Verdict::no_gap, "NO-GAP"},
                                       {Verdict::ambiguous_calibration, "AMBIGUOUS-CALIBRATION"},
                                       {Verdict::effect, "EFFECT"},
                                       {Verdict::set, "SET"},
                                       {Verdict::effects, "EFFECTS"},
                                       {Verdict::outside_library, "OUTSIDE-LIBRARY"},
                                       {Verdict::underpowered, "UNDERPOWERED"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Provenance, tool, version, git_hash, verb, seed, input_hashes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AuditItem, is_warning, text)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisPlan::Effect, name, detectability, smallest_detectability, absorbed_share, detectable_from, amplitude_text,
                                   expected_error)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisPlan::Leverage, group, largest)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisPlan::Direction, deviation, text)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisPlan, effects, separability, leverages, directions, noise_rms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisWhere, group, observable, region, regime, unit, gap, lower, upper, statistic, degrees, p, discovery, left_out_z,
                                   explained, explained_lower, explained_upper, explained_probability, explained_discovery)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisHypothesis::Amplitude, effect, mean, lower, upper, text)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisHypothesis, name, log_evidence, prior, probability, chi2, effective_samples, in_set, amplitudes, parameters)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisCurve, name, observable, regime, unit, axis_name, held_out, axis, value, uncertainty, baseline, explained)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisShrink, data, before, after, placebo, floor, shrink, lower, upper)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DiagnosisNext, name, cost, information, per_cost)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Diagnosis::Inclusion, effect, probability)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Diagnosis, name, campaign, campaign_source, verdict, statement, named, notes, audit, plan, where, hypotheses, inclusion,
                                   temperature, claim_threshold, adequacy_threshold, gap_threshold, open_threshold, baseline_p, best_p, best_name,
                                   misfit_family, nearest, transfer_p, prior_dependent, how_far, confirmation, next, curves, emulator, emulator_accepted,
                                   provenance)

namespace io {

namespace {

constexpr const char* format_name = "pelletlab diagnosis";
constexpr int format_version = 2;

/// JSON has no NaN: it is written as null and becomes NaN again.
void nulls_to_nan(Json& json) {
    if (json.is_null()) json = std::numeric_limits<double>::quiet_NaN();
    if (json.is_structured())
        for (Json& child : json) nulls_to_nan(child);
}

}  // namespace

std::string diagnosis_text(const Diagnosis& diagnosis) {
    Json json = {{"format", format_name}, {"format_version", format_version}};
    json["diagnosis"] = diagnosis;
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_diagnosis(const Diagnosis& diagnosis, const std::filesystem::path& file) {
    write_text(file, diagnosis_text(diagnosis));
}

Diagnosis read_diagnosis(const std::filesystem::path& file) {
    try {
        Json json = Json::parse(read_text(file));
        if (!json.is_object() || json.value("format", "") != format_name)
            throw bad_input("this is no diagnosis of pelletlab", "name a diagnosis.json", {file.string()});
        if (json.at("format_version") != format_version)
            throw bad_input("this diagnosis has another format version", "run pelletlab diagnose run again", {file.string()});
        nulls_to_nan(json["diagnosis"]);
        return json.at("diagnosis").get<Diagnosis>();
    } catch (const Json::exception& error) {
        throw bad_input("this diagnosis cannot be read: " + std::string(error.what()), "run pelletlab diagnose run again", {file.string()});
    }
}

}  // namespace io
}  // namespace pelletlab
