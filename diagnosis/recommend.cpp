#include "diagnosis/recommend.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

struct Predictive {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
};

/// The new data of a candidate as a data set: the whole axis of an observable in a regime.
Problem candidate_problem(const Problem& problem, const Candidate& c) {
    Experiment e;
    e.file = problem.experiment.file;
    e.settings = problem.experiment.settings;
    for (const CampaignParameter& p : problem.model->campaign.description.parameters) e.parameters.push_back({p.name, p.lower, p.lower, true, c.place});
    Measurement m;
    m.name = c.name;
    m.observable = c.observable;
    m.regime = c.regime;
    m.place = c.place;
    for (const CampaignObservable& o : problem.model->campaign.description.observables) {
        if (o.name != c.observable) continue;
        m.unit = o.unit;
        m.axis_unit = o.axis_unit;
        m.axis = o.axis;
    }
    const std::size_t n = std::max<std::size_t>(1, m.axis.size());
    m.value.assign(n, 0.0);
    m.uncertainty.assign(n, c.uncertainty);
    e.measurements.push_back(m);
    return make_problem(problem.model, e);
}

/// What a direct measurement reads at ψ: an effect's value or a parameter's.
double direct_value(const Attributor& attributor, const Candidate& c, const Hypothesis& h, const Eigen::VectorXd& psi) {
    const Model& model = *attributor.problem().model;
    Eigen::VectorXd phi, theta;
    attributor.split(h, psi, phi, theta);
    const auto& d = model.campaign.description;
    for (std::size_t i = 0; i < d.parameters.size(); ++i)
        if (d.parameters[i].name == c.direct) return campaign::value_of_coordinate(d.parameters[i], phi[static_cast<Eigen::Index>(i)]);
    for (std::size_t k = 0; k < model.library.size(); ++k) {
        const CampaignEffect& effect = model.effect(static_cast<int>(k));
        if (effect.name == c.direct) return campaign::value_of_amplitude(effect, theta[static_cast<Eigen::Index>(k)]);
    }
    throw bad_input("the candidate '" + c.name + "' measures '" + c.direct + "', which is no effect of the library and no parameter", "correct the name",
                    c.place);
}

Predictive predictive_of(const std::vector<Eigen::VectorXd>& values, const Eigen::MatrixXd& noise) {
    Predictive p{Eigen::VectorXd::Zero(values[0].size()), noise};
    for (const auto& v : values) p.mean += v / static_cast<double>(values.size());
    for (const auto& v : values) p.covariance += (v - p.mean) * (v - p.mean).transpose() / static_cast<double>(values.size());
    return p;
}

double information(const std::vector<Predictive>& predictives, const std::vector<double>& probability, std::uint64_t seed) {
    std::vector<inference::Whitener> whiteners;
    for (const Predictive& p : predictives) whiteners.emplace_back(p.covariance);
    RandomStream random(seed, 0x6e657874);
    double total = 0.0;
    for (std::size_t k = 0; k < predictives.size(); ++k) {
        if (probability[k] < 1e-4) continue;
        const int draws = std::max(10, static_cast<int>(150.0 * probability[k]));
        for (int d = 0; d < draws; ++d) {
            const Eigen::VectorXd y =
                predictives[k].mean + whiteners[k].colour(inference::draw_student(random, predictives[k].mean.size(), std::numeric_limits<double>::infinity()));
            double largest = -1e300, own = 0.0;
            std::vector<double> logs;
            for (std::size_t l = 0; l < predictives.size(); ++l) {
                const double chi2 = whiteners[l].whiten(y - predictives[l].mean).squaredNorm();
                const double value = -0.5 * (chi2 + whiteners[l].log_determinant());
                logs.push_back(value + std::log(std::max(1e-300, probability[l])));
                largest = std::max(largest, logs.back());
                if (l == k) own = value;
            }
            double sum = 0.0;
            for (const double v : logs) sum += std::exp(v - largest);
            total += probability[k] / draws * (own - largest - std::log(sum));
        }
    }
    return std::max(0.0, total);
}

}  // namespace

std::vector<DiagnosisNext> recommend(const Attributor& attributor, const Attribution& a, std::uint64_t seed) {
    std::vector<DiagnosisNext> list;
    const Problem& problem = attributor.problem();
    const auto& hypotheses = attributor.hypotheses();
    for (const Candidate& c : problem.experiment.candidates) {
        const bool direct = !c.direct.empty();
        std::unique_ptr<Problem> added;
        if (!direct) added = std::make_unique<Problem>(candidate_problem(problem, c));
        std::vector<Predictive> predictives;
        for (std::size_t h = 0; h < hypotheses.size(); ++h) {
            const Hypothesis& one = hypotheses[h];
            const auto& draws = a.fits[h].posterior.draws;
            std::vector<Eigen::VectorXd> values;
            for (const Eigen::VectorXd& psi : draws) {
                if (direct) {
                    values.push_back(Eigen::VectorXd::Constant(1, direct_value(attributor, c, one, psi)));
                } else {
                    Eigen::VectorXd phi, theta;
                    attributor.split(one, psi, phi, theta);
                    values.push_back(predict(*problem.model, added->fitted, phi, theta));
                }
            }
            Eigen::MatrixXd noise = Eigen::MatrixXd::Constant(1, 1, c.uncertainty * c.uncertainty);
            if (!direct) {
                Eigen::VectorXd phi, theta;
                attributor.split(one, a.fits[h].mode.psi, phi, theta);
                noise = covariance(*added, added->fitted, phi, theta);
            }
            predictives.push_back(predictive_of(values, noise));
            if (one.open) predictives.back().covariance *= 4.0;
        }
        DiagnosisNext next{c.name, c.cost, information(predictives, a.probability, seed), 0.0};
        next.per_cost = next.information / next.cost;
        list.push_back(next);
    }
    std::stable_sort(list.begin(), list.end(), [](const DiagnosisNext& x, const DiagnosisNext& y) { return x.per_cost > y.per_cost; });
    return list;
}

}  // namespace pelletlab::diagnosis
