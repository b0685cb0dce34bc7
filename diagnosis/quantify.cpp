#include "diagnosis/quantify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

/// Root mean square miss in tolerances; `variance` is what chance alone adds to each squared miss.
double miss_in_tolerances(const DataSet& data, const Eigen::VectorXd& y, const Eigen::VectorXd& prediction, const Eigen::VectorXd& variance) {
    double sum = 0.0;
    for (std::size_t i = 0; i < data.points.size(); ++i) {
        const auto j = static_cast<Eigen::Index>(i);
        sum += (std::pow(y[j] - prediction[j], 2) - variance[j]) / std::pow(data.points[i].tolerance, 2);
    }
    return std::sqrt(std::max(0.0, sum / static_cast<double>(data.points.size())));
}

Eigen::VectorXd prediction_of(const Attributor& attributor, const DataSet& data, int hypothesis, const Eigen::VectorXd& psi) {
    Eigen::VectorXd phi, theta;
    attributor.split(attributor.hypotheses()[static_cast<std::size_t>(hypothesis)], psi, phi, theta);
    return predict(*attributor.problem().model, data, phi, theta);
}

/// Predictions of all draws of a posterior, and their variance at each point.
struct Predictions {
    std::vector<Eigen::VectorXd> draws;
    Eigen::VectorXd variance;
};

Predictions predictions_of(const Attributor& attributor, const DataSet& data, int hypothesis, const inference::Posterior& posterior) {
    Predictions p;
    p.variance = Eigen::VectorXd::Zero(data.value.size());
    if (posterior.draws.empty()) return p;
    Eigen::VectorXd mean = p.variance;
    for (const Eigen::VectorXd& psi : posterior.draws) {
        p.draws.push_back(prediction_of(attributor, data, hypothesis, psi));
        mean += p.draws.back();
    }
    mean /= static_cast<double>(p.draws.size());
    for (const Eigen::VectorXd& draw : p.draws) p.variance += (draw - mean).cwiseAbs2() / static_cast<double>(p.draws.size());
    return p;
}

int best_placebo(const Attributor& attributor, const Attribution& a, int leading) {
    const auto& effects = attributor.hypotheses()[static_cast<std::size_t>(leading)].effects;
    int best = -1;
    for (std::size_t h = 0; h < attributor.hypotheses().size(); ++h) {
        const Hypothesis& one = attributor.hypotheses()[h];
        if (one.open || one.effects.size() != 1 || std::find(effects.begin(), effects.end(), one.effects[0]) != effects.end()) continue;
        if (best < 0 || a.probability[h] > a.probability[static_cast<std::size_t>(best)]) best = static_cast<int>(h);
    }
    return best;
}

/// Configurations whose switched-on effects are exactly these.
std::vector<int> block_of(const Model& model, const std::vector<int>& effects) {
    std::vector<int> runs;
    for (Eigen::Index i = 0; i < model.campaign.amplitude.rows(); ++i) {
        bool equal = true;
        for (std::size_t e = 0; e < model.library.size(); ++e) {
            const bool on = model.campaign.amplitude(i, model.library[e]) != 0.0;
            equal = equal && on == (std::find(effects.begin(), effects.end(), static_cast<int>(e)) != effects.end());
        }
        if (equal) runs.push_back(static_cast<int>(i));
    }
    return runs;
}

struct ClosestRun {
    int run = -1;
    double chi2 = 1e300;
};

ClosestRun closest_run(const Attributor& attributor, const std::vector<int>& runs, const Eigen::VectorXd& y, const inference::Whitener& whitener) {
    ClosestRun best;
    for (const int r : runs) {
        const Eigen::VectorXd f = attributor.problem().fitted.from_outputs * attributor.problem().model->campaign.output.row(r).transpose();
        const double chi2 = whitener.whiten(y - f).squaredNorm();
        if (chi2 < best.chi2) best = {r, chi2};
    }
    return best;
}

/// χ² of the closest point on any segment between two of the block's dozen nearest runs: a campaign's points seldom lie where the data do, and a straight line
/// between neighbours is still made of runs alone.
double closest_between_runs(const Attributor& attributor, const std::vector<int>& runs, const Eigen::VectorXd& y, const inference::Whitener& whitener) {
    constexpr std::size_t nearest = 12;
    std::vector<std::pair<double, Eigen::VectorXd>> misses;
    for (const int r : runs) {
        Eigen::VectorXd miss = whitener.whiten(y - attributor.problem().fitted.from_outputs * attributor.problem().model->campaign.output.row(r).transpose());
        const double chi2 = miss.squaredNorm();
        misses.emplace_back(chi2, std::move(miss));
    }
    std::stable_sort(misses.begin(), misses.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    if (misses.size() > nearest) misses.resize(nearest);
    double best = misses[0].first;
    for (std::size_t i = 0; i < misses.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Eigen::VectorXd step = misses[j].second - misses[i].second;
            const double square = step.squaredNorm();
            if (square < 1e-12) continue;
            const double t = std::clamp(-misses[i].second.dot(step) / square, 0.0, 1.0);
            best = std::min(best, (misses[i].second + t * step).squaredNorm());
        }
    return best;
}

}  // namespace

std::vector<DiagnosisShrink> quantify(const Attributor& attributor, const Attribution& a, int leading, std::uint64_t seed) {
    std::vector<DiagnosisShrink> rows;
    const Problem& problem = attributor.problem();
    const int placebo = best_placebo(attributor, a, leading);
    const auto& before_fit = a.fits[0].posterior;
    const auto& after_fit = a.fits[static_cast<std::size_t>(leading)].posterior;
    const auto add = [&](const std::string& name, const DataSet& data) {
        if (data.empty()) return;
        DiagnosisShrink s;
        s.data = name;
        const Eigen::VectorXd noise_variance = data.measurement_covariance.diagonal();
        const auto miss = [&](int hypothesis, const inference::Posterior& fit) {
            return miss_in_tolerances(data, data.value, prediction_of(attributor, data, hypothesis, fit.mean), noise_variance);
        };
        s.before = miss(0, before_fit);
        s.after = miss(leading, after_fit);
        s.placebo = placebo < 0 ? not_known : miss(placebo, a.fits[static_cast<std::size_t>(placebo)].posterior);
        double floor = 0.0;
        for (Eigen::Index i = 0; i < data.value.size(); ++i)
            floor += noise_variance[i] / std::pow(data.points[static_cast<std::size_t>(i)].tolerance, 2) / static_cast<double>(data.value.size());
        s.floor = std::sqrt(floor);
        s.shrink = s.before > 0.0 ? 1.0 - s.after / s.before : 0.0;
        RandomStream random(seed, 0x71756e74);
        const inference::Whitener noise(data.measurement_covariance + 1e-18 * Eigen::MatrixXd::Identity(data.value.size(), data.value.size()));
        const Predictions before = predictions_of(attributor, data, 0, before_fit), after = predictions_of(attributor, data, leading, after_fit);
        std::vector<double> shrinks;
        for (int d = 0; d < 300 && !before.draws.empty() && !after.draws.empty(); ++d) {
            const Eigen::VectorXd y = data.value + noise.colour(inference::draw_student(random, data.value.size(), std::numeric_limits<double>::infinity()));
            // The data hold noise already and y holds it twice; a draw misses by its own scatter too. All of it is taken out, as above.
            const auto miss_of_draw = [&](const Predictions& p) {
                const auto& draw = p.draws[static_cast<std::size_t>(random.uniform() * static_cast<double>(p.draws.size()))];
                return miss_in_tolerances(data, y, draw, 2.0 * noise_variance + p.variance);
            };
            const double gap_before = miss_of_draw(before), gap_after = miss_of_draw(after);
            if (gap_before > 0.0) shrinks.push_back(1.0 - gap_after / gap_before);
        }
        s.lower = shrinks.empty() ? not_known : inference::quantile(shrinks, 0.05);
        s.upper = shrinks.empty() ? not_known : inference::quantile(shrinks, 0.95);
        rows.push_back(s);
    };
    add("fitted", problem.fitted);
    add("held out", problem.held_out);
    return rows;
}

bool runs_confirm_pair(const Attributor& attributor, const Attribution& a, const Eigen::VectorXd& y, int pair) {
    const auto& effects = attributor.hypotheses()[static_cast<std::size_t>(pair)].effects;
    if (effects.size() != 2) return false;
    const Model& model = *attributor.problem().model;
    const auto both = block_of(model, effects);
    if (both.empty()) return false;
    const inference::Whitener& whitener = a.fits[static_cast<std::size_t>(pair)].whitener;
    const double together = closest_between_runs(attributor, both, y, whitener);
    for (const int e : effects) {
        const auto single = block_of(model, {e});
        if (single.empty()) return false;
        const double alone = closest_between_runs(attributor, single, y, whitener);
        const double selection = 2.0 * std::log(std::max(1.0, static_cast<double>(both.size()) / static_cast<double>(single.size())));
        if (alone - together < 9.0 + selection) return false;
    }
    return true;
}

double shrink_by_runs(const Attributor& attributor, const Attribution& a, int leading, bool held_out) {
    const Problem& problem = attributor.problem();
    const DataSet& data = held_out ? problem.held_out : problem.fitted;
    const auto base = block_of(*problem.model, {}), with = block_of(*problem.model, attributor.hypotheses()[static_cast<std::size_t>(leading)].effects);
    if (data.empty() || base.empty() || with.empty() || leading == 0) return not_known;
    const inference::Whitener& whitener = a.fits[0].whitener;
    const auto miss = [&](const std::vector<int>& runs) {
        const int run = closest_run(attributor, runs, problem.fitted.value, whitener).run;
        return miss_in_tolerances(data, data.value, data.from_outputs * problem.model->campaign.output.row(run).transpose(),
                                  data.measurement_covariance.diagonal());
    };
    const double before = miss(base);
    return before > 0.0 ? 1.0 - miss(with) / before : not_known;
}

}  // namespace pelletlab::diagnosis
