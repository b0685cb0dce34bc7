#include "diagnosis/calibrate.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "campaign/assemble.hpp"

namespace pelletlab::diagnosis {

namespace {

constexpr double half_open = 0.5;  // posterior over prior deviation from which a direction counts as left open

Eigen::MatrixXd covariance_of(const std::vector<Eigen::VectorXd>& draws) {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(draws.front().size());
    for (const auto& d : draws) mean += d / static_cast<double>(draws.size());
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(mean.size(), mean.size());
    for (const auto& d : draws) c += (d - mean) * (d - mean).transpose() / static_cast<double>(draws.size() - 1);
    return c;
}

std::string direction_text(const Eigen::VectorXd& v, const std::vector<CampaignParameter>& parameters) {
    std::vector<Eigen::Index> order(static_cast<std::size_t>(v.size()));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return std::abs(v[a]) > std::abs(v[b]); });
    const double sign = v[order[0]] < 0.0 ? -1.0 : 1.0;
    std::string text;
    for (const Eigen::Index i : order) {
        const double x = sign * v[i];
        if (std::abs(x) < 0.2) continue;
        text += fmt::format("{}{:.1f} {}", text.empty() ? "" : x < 0.0 ? " − " : " + ", std::abs(x), parameters[static_cast<std::size_t>(i)].name);
    }
    return text;
}

}  // namespace

Calibration calibrate(const Attributor& attributor) {
    const Problem& problem = attributor.problem();
    const auto& parameters = problem.model->campaign.description.parameters;
    const auto p = static_cast<Eigen::Index>(parameters.size());
    const Eigen::VectorXd& y = problem.fitted.value;
    const Fit fit = attributor.fit(0, y, false);
    std::vector<int> rows(static_cast<std::size_t>(y.size()));
    std::iota(rows.begin(), rows.end(), 0);
    const inference::Inference inference = attributor.inference_of(attributor.hypotheses()[0], y, fit.whitener, rows);
    inference::SamplingOptions sampling;
    sampling.samples = 4000;
    sampling.rounds = 4;
    sampling.draws = 800;
    sampling.seed = problem.experiment.settings.seed;
    const inference::Posterior posterior = inference::sample_posterior(inference, fit.mode, sampling);

    Calibration c;
    c.chi2 = fit.mode.chi2;
    c.data = static_cast<int>(y.size());
    c.effective_samples = posterior.effective_samples;
    const Adequacy adequacy =
        test_adequacy(problem, fit, noise_draws(problem, problem.experiment.settings.bootstrap, problem.experiment.settings.seed, 0x61646571));
    c.adequacy_p = adequacy.p;
    c.misfit = adequacy.family;

    const Eigen::MatrixXd covariance = covariance_of(posterior.draws);
    Eigen::VectorXd prior = (problem.phi_upper - problem.phi_lower) / std::sqrt(12.0);
    prior = (prior.array() < 1e-5).select(0.0, prior);  // known parameters
    c.correlation = covariance;
    for (Eigen::Index i = 0; i < p; ++i)
        for (Eigen::Index j = 0; j < p; ++j) {
            const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
            c.correlation(i, j) = scale > 0.0 ? covariance(i, j) / scale : (i == j ? 1.0 : 0.0);
        }
    for (Eigen::Index i = 0; i < p; ++i) {
        const CampaignParameter& parameter = parameters[static_cast<std::size_t>(i)];
        const auto value = [&](double phi) { return campaign::value_of_coordinate(parameter, phi); };
        CalibratedParameter one;
        one.name = parameter.name;
        one.unit = parameter.unit;
        one.prior_lower = value(problem.phi_lower[i]);
        one.prior_upper = value(problem.phi_upper[i]);
        one.best = value(fit.mode.psi[i]);
        one.mean = value(posterior.mean[i]);
        one.lower = value(posterior.lower[i]);
        one.upper = value(posterior.upper[i]);
        one.narrowed = prior[i] > 0.0 ? std::sqrt(covariance(i, i)) / prior[i] : 0.0;
        if (prior[i] > 0.0) {
            std::vector<double> phi;
            constexpr int steps = 25;
            for (int k = 0; k < steps; ++k) phi.push_back(problem.phi_lower[i] + (problem.phi_upper[i] - problem.phi_lower[i]) * k / (steps - 1.0));
            const auto chi2 = inference::profile_chi2(inference, i, phi, fit.mode.psi);
            const double least = std::min(fit.mode.chi2, *std::min_element(chi2.begin(), chi2.end()));
            for (int k = 0; k < steps; ++k) {
                one.profile_value.push_back(value(phi[static_cast<std::size_t>(k)]));
                one.profile_chi2.push_back(chi2[static_cast<std::size_t>(k)] - least);
            }
        }
        c.parameters.push_back(one);
    }
    for (const Eigen::VectorXd& draw : posterior.draws) {
        Eigen::VectorXd values(p);
        for (Eigen::Index i = 0; i < p; ++i) values[i] = campaign::value_of_coordinate(parameters[static_cast<std::size_t>(i)], draw[i]);
        c.draws.push_back(values);
    }

    // Directions in units of the prior, over the parameters that are free.
    std::vector<int> free;
    for (Eigen::Index i = 0; i < p; ++i)
        if (prior[i] > 0.0) free.push_back(static_cast<int>(i));
    std::vector<CampaignParameter> free_parameters;
    for (const int i : free) free_parameters.push_back(parameters[static_cast<std::size_t>(i)]);
    const Eigen::VectorXd scale = prior(free).cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * Eigen::MatrixXd(covariance(free, free)) * scale.asDiagonal());
    for (Eigen::Index i = static_cast<Eigen::Index>(free.size()) - 1; i >= 0; --i) {
        const double deviation = std::sqrt(std::max(0.0, eigen.eigenvalues()[i]));
        if (deviation >= half_open) c.open.push_back({direction_text(eigen.eigenvectors().col(i), free_parameters), deviation});
    }

    // What each measurable thing of the campaign would still tell.
    const Campaign& campaign = problem.model->campaign;
    const Eigen::VectorXd theta = Eigen::VectorXd::Zero(problem.model->effects());
    std::vector<Eigen::VectorXd> fields;
    for (std::size_t d = 0; d < posterior.draws.size(); d += 4) fields.push_back(problem.model->emulator.field(posterior.draws[d].head(p), theta));
    const Eigen::MatrixXd one_run = problem.model->emulator.basis().modes * problem.model->emulator.score_covariance(fit.mode.psi.head(p), theta, true) *
                                    problem.model->emulator.basis().modes.transpose();
    for (std::size_t o = 0; o < campaign.description.observables.size(); ++o)
        for (std::size_t r = 0; r < campaign.regimes.size(); ++r) {
            std::vector<int> outputs;
            for (std::size_t j = 0; j < campaign.outputs.size(); ++j)
                if (campaign.outputs[j].observable == static_cast<int>(o) && campaign.outputs[j].regime == static_cast<int>(r))
                    outputs.push_back(static_cast<int>(j));
            if (outputs.empty()) continue;
            std::vector<Eigen::VectorXd> predicted;
            for (const auto& f : fields) predicted.emplace_back(f(outputs));
            const double floor = 0.5 * campaign.description.observables[o].tolerance;
            Eigen::MatrixXd noise = one_run(outputs, outputs);
            noise.diagonal().array() += floor * floor;
            const Eigen::MatrixXd whole = noise + covariance_of(predicted);
            const double information = 0.5 * (whole.ldlt().vectorD().array().max(1e-300).log().sum() - noise.ldlt().vectorD().array().max(1e-300).log().sum());
            c.next.push_back({campaign.description.observables[o].name, campaign.regimes[r].name, std::max(0.0, information)});
        }
    std::stable_sort(c.next.begin(), c.next.end(), [](const NextMeasurement& a, const NextMeasurement& b) { return a.information > b.information; });
    return c;
}

}  // namespace pelletlab::diagnosis
