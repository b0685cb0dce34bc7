#include "diagnosis/plan.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

std::size_t hypothesis_index(const std::vector<Hypothesis>& hypotheses, const std::vector<int>& effects) {
    for (std::size_t h = 0; h < hypotheses.size(); ++h)
        if (!hypotheses[h].open && hypotheses[h].effects == effects) return h;
    throw numerical_failure("a hypothesis is missing");
}

double separation(const Attributor& attributor, const Eigen::VectorXd& phi, const Eigen::VectorXd& theta, std::size_t rival) {
    const Problem& problem = attributor.problem();
    const Eigen::VectorXd truth = predict(*problem.model, problem.fitted, phi, theta);
    std::vector<int> rows(static_cast<std::size_t>(truth.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
    const inference::Whitener whitener(covariance(problem, problem.fitted, phi, theta));
    inference::Inference distance = attributor.inference_of(attributor.hypotheses()[rival], truth, whitener, rows);
    distance.nu = std::numeric_limits<double>::infinity();
    distance.prior_deviation.setConstant(std::numeric_limits<double>::infinity());
    std::vector<Eigen::VectorXd> starts;
    for (const double t : {0.1, 0.6}) {
        Eigen::VectorXd start = 0.5 * (distance.lower + distance.upper);
        start.head(phi.size()) = phi;
        start.tail(start.size() - phi.size()).setConstant(t);
        starts.push_back(start);
        if (start.size() == phi.size()) break;
    }
    return inference::find_mode(distance, starts, 10).chi2;
}

namespace {

double median(std::vector<double> values) {
    return inference::quantile(std::move(values), 0.5);
}

void add_leverages(const Attributor& attributor, const Eigen::VectorXd& phi, DiagnosisPlan& plan) {
    const Problem& problem = attributor.problem();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.model->effects());
    const Eigen::VectorXd y = predict(*problem.model, problem.fitted, phi, none);
    std::vector<int> rows(static_cast<std::size_t>(y.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
    const inference::Whitener whitener(covariance(problem, problem.fitted, phi, none));
    auto inference = attributor.inference_of(attributor.hypotheses()[0], y, whitener, rows);
    inference.nu = std::numeric_limits<double>::infinity();  // exact data would count as far too good for a Student t, and sharpen everything
    const inference::Mode mode = inference::find_mode(inference, {phi}, 1);
    const Eigen::MatrixXd posterior = mode.precision.ldlt().solve(Eigen::MatrixXd::Identity(phi.size(), phi.size()));
    const Eigen::MatrixXd hat = mode.jacobian * posterior * mode.jacobian.transpose();
    for (const Group& g : problem.fitted.groups) {
        double largest = 0.0;
        for (const int i : g.points) largest = std::max(largest, hat(i, i));
        plan.leverages.push_back({g.name, largest});
    }
    // Directions of the parameters' range that the data leave free, widest first, in units of the range's own standard deviation.
    const Eigen::VectorXd width = (problem.phi_upper - problem.phi_lower) / std::sqrt(12.0);
    const Eigen::MatrixXd scaled = width.cwiseInverse().asDiagonal() * posterior * width.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    const auto& parameters = problem.model->campaign.description.parameters;
    for (Eigen::Index d = scaled.rows() - 1; d >= 0; --d) {
        std::string text;
        for (Eigen::Index i = 0; i < scaled.rows(); ++i) {
            const double c = eigen.eigenvectors()(i, d);
            if (std::abs(c) < 0.1) continue;
            text += fmt::format("{}{:.2f} {}", text.empty() ? (c < 0 ? "−" : "") : (c < 0 ? " − " : " + "), std::abs(c),
                                parameters[static_cast<std::size_t>(i)].name);
        }
        plan.directions.push_back({std::min(1.0, std::sqrt(eigen.eigenvalues()[d])), text});
    }
}

}  // namespace

DiagnosisPlan make_plan(const Attributor& attributor, int points) {
    DiagnosisPlan plan;
    const Problem& problem = attributor.problem();
    const auto k = static_cast<int>(problem.model->effects());
    std::vector<Eigen::VectorXd> phis;
    for (int i = 0; i < points; ++i) {
        const Eigen::VectorXd u = inference::halton(static_cast<std::uint64_t>(i) + 1, static_cast<int>(problem.phi_lower.size()));
        phis.push_back(problem.phi_lower + u.cwiseProduct(problem.phi_upper - problem.phi_lower));
    }
    plan.separability.assign(static_cast<std::size_t>(k), std::vector<double>(static_cast<std::size_t>(k), 0.0));
    for (int e = 0; e < k; ++e) {
        const CampaignEffect& effect = problem.model->effect(e);
        std::vector<double> detect, absorbed, raw;
        std::vector<std::vector<double>> apart(static_cast<std::size_t>(k));
        Eigen::VectorXd theta = Eigen::VectorXd::Zero(k);
        theta[e] = 1.0;
        for (const Eigen::VectorXd& phi : phis) {
            detect.push_back(separation(attributor, phi, theta, 0));
            const inference::Whitener whitener(covariance(problem, problem.fitted, phi, theta));
            const double whole =
                whitener.whiten(predict(*problem.model, problem.fitted, phi, theta) - predict(*problem.model, problem.fitted, phi, Eigen::VectorXd::Zero(k)))
                    .squaredNorm();
            absorbed.push_back(1.0 - std::min(1.0, detect.back() / std::max(whole, 1e-12)));
            for (int other = 0; other < k; ++other)
                if (other != e)
                    apart[static_cast<std::size_t>(other)].push_back(separation(attributor, phi, theta, hypothesis_index(attributor.hypotheses(), {other})));
        }
        DiagnosisPlan::Effect row;
        row.name = effect.name;
        row.detectability = median(detect);
        row.smallest_detectability = *std::min_element(detect.begin(), detect.end());
        row.absorbed_share = median(absorbed);
        row.detectable_from = not_known;
        row.amplitude_text = "not at all";
        if (row.detectability >= 9.0) {  // bisection at the middle of the range
            double low = 0.0, high = 1.0;
            for (int i = 0; i < 7; ++i) {
                const double middle = 0.5 * (low + high);
                Eigen::VectorXd t = Eigen::VectorXd::Zero(k);
                t[e] = middle;
                (separation(attributor, phis[0], t, 0) >= 9.0 ? high : low) = middle;
            }
            row.detectable_from = high;
            row.amplitude_text = fmt::format("{:.3g} {}", campaign::value_of_amplitude(effect, high), effect.unit == "1" ? "" : effect.unit);
        }
        for (int other = 0; other < k; ++other) {
            if (other == e) continue;
            const double lambda = median(apart[static_cast<std::size_t>(other)]);
            plan.separability[static_cast<std::size_t>(e)][static_cast<std::size_t>(other)] = lambda;
            row.expected_error += inference::normal_cdf(-0.5 * std::sqrt(lambda));
        }
        row.expected_error = std::min(1.0, row.expected_error);  // a sum over rivals bounds a probability only as far as it is one
        plan.effects.push_back(row);
    }
    add_leverages(attributor, phis[0], plan);
    const Eigen::VectorXd sigma = covariance(problem, problem.fitted, phis[0], Eigen::VectorXd::Zero(k)).diagonal().cwiseSqrt();
    double sum = 0.0;
    for (Eigen::Index i = 0; i < sigma.size(); ++i) sum += std::pow(sigma[i] / problem.fitted.points[static_cast<std::size_t>(i)].tolerance, 2);
    plan.noise_rms = std::sqrt(sum / static_cast<double>(sigma.size()));
    return plan;
}

}  // namespace pelletlab::diagnosis
