#include "diagnosis/recalibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

Thresholds thresholds_from(std::vector<RehearsedCase> cases, const std::vector<Hypothesis>& hypotheses, Eigen::Index effects) {
    Thresholds t;
    double best = -1e300;
    // Never below 1: a reality that does not use up its tolerance must not sharpen anything.
    for (const double temperature : {1.0, 1.2, 1.5, 1.9, 2.4, 3.0, 4.0, 5.5, 7.5}) {
        double score = 0.0;
        for (RehearsedCase& one : cases) {
            normalise(one.attribution, hypotheses, temperature, effects);
            const auto& truth = hypotheses[one.truth].effects;
            for (std::size_t e = 0; e < one.attribution.inclusion.size(); ++e) {
                const bool is_there = std::find(truth.begin(), truth.end(), static_cast<int>(e)) != truth.end();
                score -= std::pow(one.attribution.inclusion[e] - (is_there ? 1.0 : 0.0), 2);
            }
        }
        if (score > best) {
            best = score;
            t.temperature = temperature;
        }
    }
    std::vector<double> null_claims, null_gaps, adequacy, open;
    for (RehearsedCase& one : cases) {
        normalise(one.attribution, hypotheses, t.temperature, effects);
        const auto& p = one.attribution.inclusion;
        if (one.truth == 0 && !p.empty()) {
            null_claims.push_back(*std::max_element(p.begin(), p.end()));
            null_gaps.push_back(1.0 - one.attribution.probability_of_none);
        }
        adequacy.push_back(one.attribution.adequacy.p);
        open.push_back(one.attribution.probability_of_open);
        t.runs += one.is_run ? 1 : 0;
    }
    t.cases = static_cast<int>(cases.size());
    if (null_claims.size() >= 20) {
        t.claim = std::clamp(inference::quantile(null_claims, 0.95), 0.90, 0.995);
        t.gap = std::clamp(inference::quantile(null_gaps, 0.95), 0.5, 0.95);
    }
    if (adequacy.size() >= 20) {
        t.adequacy = std::clamp(inference::quantile(adequacy, 0.02), 0.01, 0.05);
        t.open = std::clamp(inference::quantile(open, 0.98), 0.5, 0.99);
    }
    for (const double c : null_claims) t.null_false_alarm += (c >= t.claim ? 1.0 : 0.0) / static_cast<double>(null_claims.size());
    return t;
}

Thresholds recalibrate(const Attributor& attributor, int cases, std::uint64_t seed, const ProgressSink& progress) {
    if (cases == 0) return {};
    std::vector<RehearsedCase> all = left_out_cases(attributor, cases / 2, seed, progress);
    for (RehearsedCase& one : simulated_cases(attributor, cases - static_cast<int>(all.size()), seed, progress)) all.push_back(std::move(one));
    return thresholds_from(std::move(all), attributor.hypotheses(), attributor.problem().model->effects());
}

std::string thresholds_text(const Thresholds& t) {
    return fmt::format("temperature {:.17g} claim {:.17g} gap {:.17g} open {:.17g} adequacy {:.17g} cases {} runs {} null_false_alarm {:.17g}\n", t.temperature,
                       t.claim, t.gap, t.open, t.adequacy, t.cases, t.runs, t.null_false_alarm);
}

}  // namespace pelletlab::diagnosis
