#include "diagnosis/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pelletlab::diagnosis {

namespace {

std::vector<int> by_inclusion(const Attribution& a) {
    std::vector<int> order(a.inclusion.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int x, int y) { return a.inclusion[static_cast<std::size_t>(x)] > a.inclusion[static_cast<std::size_t>(y)]; });
    return order;
}

/// Effects in any hypothesis of the 90 % set, most probable first.
std::vector<int> effects_of_set(const std::vector<Hypothesis>& hypotheses, const Attribution& a) {
    std::vector<int> effects;
    for (const int e : by_inclusion(a))
        if (std::any_of(a.credible_set.begin(), a.credible_set.end(), [&](int h) {
                const auto& in = hypotheses[static_cast<std::size_t>(h)].effects;
                return std::find(in.begin(), in.end(), e) != in.end();
            }))
            effects.push_back(e);
    return effects;
}

}  // namespace

Judgement judge(const std::vector<Hypothesis>& hypotheses, const Evidence& evidence, const Thresholds& t) {
    const Attribution& a = *evidence.attribution;
    const bool baseline_adequate = a.baseline_adequacy.p >= t.adequacy;
    std::vector<int> claimed;
    for (const int e : by_inclusion(a))
        if (a.inclusion[static_cast<std::size_t>(e)] >= t.claim) claimed.push_back(e);

    // An explanation of the library that describes the data without any doubt is not ruled out by a shape that nobody can name.
    if (a.probability_of_open >= t.open && a.adequacy.p < 0.2) return {Verdict::outside_library, {}, "the open class is the most probable explanation"};
    if (a.adequacy.p < t.adequacy) return {Verdict::outside_library, {}, "the best explanation of the library does not describe the data"};
    if (baseline_adequate && claimed.empty() && 1.0 - a.probability_of_none < t.gap) {
        if (evidence.best_detectability < 9.0) return {Verdict::underpowered, {}, "no effect of the library could have been seen with these data"};
        if (!std::isnan(evidence.transfer_p) && evidence.transfer_p < 0.05)
            return {Verdict::ambiguous_calibration, {}, "the data calibrated on leave the parameters open: another set fits everything"};
        return {Verdict::no_gap, {}, "the calibrated baseline describes the data"};
    }
    if (claimed.size() >= 2) {
        std::vector<int> pair{claimed[0], claimed[1]};
        std::sort(pair.begin(), pair.end());
        double best_single = -1e300, together = -1e300;
        for (std::size_t h = 0; h < hypotheses.size(); ++h) {
            if (hypotheses[h].open) continue;
            if (hypotheses[h].effects.size() == 1) best_single = std::max(best_single, a.log_evidence[h]);
            if (hypotheses[h].effects == pair) together = a.log_evidence[h];
        }
        if (together - best_single >= 3.0 && evidence.second_effect_confirmed) return {Verdict::effects, {claimed[0], claimed[1]}, "both effects are needed"};
        return {Verdict::effect, {claimed[0]}, "a second effect is likely but not confirmed by runs, so it is not named"};
    }
    if (claimed.size() == 1) return {Verdict::effect, claimed, "one effect explains the gap"};
    const auto set = effects_of_set(hypotheses, a);
    if (set.empty() && baseline_adequate) return {Verdict::no_gap, {}, "the calibrated baseline describes the data"};
    return {Verdict::set, set, "these data cannot tell the explanations apart"};
}

}  // namespace pelletlab::diagnosis
