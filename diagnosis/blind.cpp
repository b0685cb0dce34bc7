#include "diagnosis/blind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/baselines.hpp"
#include "diagnosis/plan.hpp"

namespace pelletlab::diagnosis {

namespace {

constexpr int folds = 4;

/// Fold of every point: sum of the ranks of its parameter values, modulo the number of folds (a Latin pattern on a grid, so every value keeps trained
/// neighbours).
std::vector<int> folds_of(const Campaign& c) {
    std::vector<int> fold(static_cast<std::size_t>(c.parameter.rows()), 0);
    for (Eigen::Index j = 0; j < c.parameter.cols(); ++j) {
        std::set<double> values;
        for (Eigen::Index i = 0; i < c.parameter.rows(); ++i) values.insert(c.parameter(i, j));
        for (Eigen::Index i = 0; i < c.parameter.rows(); ++i)
            fold[static_cast<std::size_t>(i)] += static_cast<int>(std::distance(values.begin(), values.find(c.parameter(i, j))));
    }
    for (int& f : fold) f %= folds;
    return fold;
}

std::vector<std::vector<std::pair<std::string, double>>> points_of_fold(const Campaign& c, const std::vector<int>& fold, int wanted) {
    std::vector<std::vector<std::pair<std::string, double>>> points;
    std::set<int> seen;
    for (Eigen::Index i = 0; i < c.parameter.rows(); ++i) {
        if (fold[static_cast<std::size_t>(i)] != wanted || !seen.insert(c.point[static_cast<std::size_t>(i)]).second) continue;
        std::vector<std::pair<std::string, double>> point;
        for (Eigen::Index j = 0; j < c.parameter.cols(); ++j) point.emplace_back(c.description.parameters[static_cast<std::size_t>(j)].name, c.parameter(i, j));
        points.push_back(point);
    }
    return points;
}

std::vector<int> active_effects(const Campaign& c, int configuration) {
    std::vector<int> active;
    for (Eigen::Index k = 0; k < c.amplitude.cols(); ++k)
        if (c.amplitude(configuration, k) != 0.0) active.push_back(static_cast<int>(k));
    return active;
}

template <class Item>
void shuffle(std::vector<Item>& items, RandomStream& random) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
}

}  // namespace

std::vector<BlindCase> draw_blind_cases(const Campaign& c, const BlindCounts& counts, std::uint64_t seed, const std::vector<int>& taken) {
    RandomStream random(seed, 0x626c696e64);  // «blind»: no stream of the campaign or of the diagnosis
    const auto fold = folds_of(c);
    std::set<int> used(taken.begin(), taken.end());
    const auto k = static_cast<int>(c.amplitude.cols());
    const auto draw = [&](const auto& wanted) {
        std::vector<int> pool;
        for (Eigen::Index i = 0; i < c.output.rows(); ++i)
            if (used.count(static_cast<int>(i)) == 0 && wanted(active_effects(c, static_cast<int>(i)))) pool.push_back(static_cast<int>(i));
        if (pool.empty()) return -1;
        const int chosen = pool[static_cast<std::size_t>(random.uniform() * static_cast<double>(pool.size()))];
        used.insert(chosen);
        return chosen;
    };
    std::vector<BlindCase> cases;
    const auto add = [&](const std::string& kind, int configuration, int removed) {
        if (configuration < 0) return;
        BlindCase one;
        one.label.kind = kind;
        one.label.configuration = configuration;
        for (const int e : active_effects(c, configuration)) {
            one.label.effects.push_back(c.description.effects[static_cast<std::size_t>(e)].name);
            one.label.amplitude.push_back(c.amplitude(configuration, e));
        }
        for (int e = 0; e < k; ++e)
            if (e != removed) one.library.push_back(c.description.effects[static_cast<std::size_t>(e)].name);
        one.exclude = points_of_fold(c, fold, fold[static_cast<std::size_t>(configuration)]);
        cases.push_back(one);
    };
    const auto only = [](int e) { return [e](const std::vector<int>& a) { return a == std::vector<int>{e}; }; };
    for (int i = 0; i < counts.null; ++i) add("null", draw([](const std::vector<int>& a) { return a.empty(); }), -1);
    for (int i = 0; i < counts.single; ++i) add("single", draw(only(i % k)), -1);
    for (int i = 0; i < counts.pair; ++i) add("pair", draw([](const std::vector<int>& a) { return a.size() == 2; }), -1);
    for (int i = 0; i < counts.outside; ++i) add("outside", draw(only(i % k)), i % k);
    for (int i = 0; i < counts.reduced; ++i) add("reduced", draw(only(i % k)), (i + 1) % k);
    if (cases.size() < static_cast<std::size_t>(std::max(1, (counts.null + counts.single + counts.pair + counts.outside + counts.reduced) / 2)))
        throw bad_input("the campaign has too few unused runs for this many blind cases", "ask for fewer", {c.description.file});
    shuffle(cases, random);
    for (std::size_t i = 0; i < cases.size(); ++i) cases[i].label.id = fmt::format("case_{:03}", i + 1);
    return cases;
}

Experiment blind_experiment(const Campaign& c, const Experiment& from, const BlindCase& one) {
    Experiment e;
    e.name = one.label.id;
    e.file = from.file;
    e.campaign_file = from.campaign_file;
    e.library = one.library;
    e.exclude = one.exclude;
    e.regions = from.regions;
    e.settings = from.settings;
    for (std::size_t r = 0; r < c.regimes.size(); ++r)
        for (std::size_t o = 0; o < c.description.observables.size(); ++o) {
            const CampaignObservable& observable = c.description.observables[o];
            Measurement m;
            m.observable = observable.name;
            m.regime = c.description.regime_name.empty() ? "" : c.regimes[r].name;
            m.name = observable.name + " " + m.regime;
            m.unit = observable.unit;
            m.axis_unit = observable.axis_unit;
            m.instrument = m.regime;
            for (std::size_t j = 0; j < c.outputs.size(); ++j) {
                const CampaignOutput& out = c.outputs[j];
                if (out.regime != static_cast<int>(r) || out.observable != static_cast<int>(o)) continue;
                if (!observable.axis.empty()) m.axis.push_back(observable.axis[static_cast<std::size_t>(out.element)]);
                m.value.push_back(c.output(one.label.configuration, static_cast<Eigen::Index>(j)));
                m.uncertainty.push_back(0.1 * observable.tolerance);
            }
            if (!m.value.empty()) e.measurements.push_back(m);
        }
    return e;
}

void measure_label(BlindLabel& label, const Campaign& c, const Attributor& attributor) {
    const Problem& problem = attributor.problem();
    const auto& library = problem.model->library;
    Eigen::VectorXd phi(c.parameter.cols()), theta = Eigen::VectorXd::Zero(problem.model->effects());
    for (Eigen::Index i = 0; i < phi.size(); ++i)
        phi[i] = std::clamp(campaign::unit_coordinate(c.description.parameters[static_cast<std::size_t>(i)], c.parameter(label.configuration, i)), 0.0, 1.0);
    for (std::size_t e = 0; e < library.size(); ++e) theta[static_cast<Eigen::Index>(e)] = c.amplitude(label.configuration, library[e]);
    label.detectability = separation(attributor, phi, theta, 0);
    label.separability = 1e9;
    for (std::size_t h = 0; h < attributor.hypotheses().size(); ++h) {
        const Hypothesis& rival = attributor.hypotheses()[h];
        if (rival.open || rival.effects.empty()) continue;
        const bool holds_truth = std::any_of(rival.effects.begin(), rival.effects.end(), [&](int e) { return theta[e] != 0.0; });
        const bool is_rival = label.kind == "outside" ? !holds_truth : rival.effects.size() == 1 && (label.effects.size() != 1 || !holds_truth);
        if (is_rival) label.separability = std::min(label.separability, separation(attributor, phi, theta, h));
    }
    if (label.effects.empty()) return;
    // Where the baseline, refitted to the noise-free truth, misses it.
    const Eigen::VectorXd y = predict(*problem.model, problem.fitted, phi, theta);
    const Fit fit = attributor.fit(0, y, false);
    const Eigen::VectorXd shift = fit.whitener.colour(fit.mode.residual).cwiseQuotient(fit.whitener.factor().rowwise().norm());
    std::vector<std::pair<double, std::string>> order;
    for (const Group& g : problem.fitted.groups) order.emplace_back(-Eigen::VectorXd(shift(g.points)).squaredNorm(), g.name);
    std::sort(order.begin(), order.end());
    for (const auto& [square, name] : order) {
        if (-square >= 9.0) label.regions.push_back(name);
        if (-square < 1.0) label.silent.push_back(name);
    }
}

BlindVerdict blind_verdict(const Problem& problem, const Thresholds& thresholds) {
    const Attributor attributor(problem);
    const Assessment assessment = assess(attributor, thresholds, false);
    const Attribution& a = assessment.attribution;
    const auto name = [&](int e) { return problem.model->effect(e).name; };
    BlindVerdict v;
    v.id = problem.experiment.name;
    v.verdict = verdict_code(assessment.judgement.verdict);
    for (const int e : assessment.judgement.named) v.named.push_back(name(e));
    for (const DiagnosisWhere& w : assessment.where) {
        if (w.discovery || w.explained_discovery) v.discoveries.push_back(w.group);
        if (w.discovery) v.measured_discoveries.push_back(w.group);
    }
    for (std::size_t e = 0; e < a.inclusion.size(); ++e) v.inclusion[name(static_cast<int>(e))] = a.inclusion[e];
    v.probability_of_open = a.probability_of_open;
    v.probability_of_none = a.probability_of_none;
    v.pair_gain = std::isfinite(assessment.pair_gain) ? assessment.pair_gain : 0.0;  // a library of one effect has no pair
    v.pair_confirmed = assessment.pair_confirmed;
    v.best_p = a.adequacy.p;
    for (const int h : a.credible_set) v.credible_set.push_back(attributor.hypotheses()[static_cast<std::size_t>(h)].name);
    for (const BaselineRanking& rule : baseline_rankings(attributor, problem.fitted.value, a)) {
        auto& list = v.rules[rule.rule];
        for (const int e : rule.effects) list.push_back(name(e));
    }
    return v;
}

}  // namespace pelletlab::diagnosis
