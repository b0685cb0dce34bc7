#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "diagnosis/attribute.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

constexpr int cloud_size = 40;
const double infinity = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Hypothesis> make_hypotheses(const Problem& problem, const Priors& priors) {
    const auto& suspects = problem.experiment.suspects;
    const auto k = static_cast<int>(problem.model->effects());
    const auto name = [&](int e) { return problem.model->effect(e).name; };
    const auto weight = [&](int e) { return std::find(suspects.begin(), suspects.end(), name(e)) == suspects.end() ? 1.0 : 3.0; };
    double singles = 0.0, pairs = 0.0;
    for (int a = 0; a < k; ++a) {
        singles += weight(a);
        for (int b = 0; b < a; ++b) pairs += weight(a) * weight(b);
    }
    std::vector<Hypothesis> list{{{}, false, "parameters only", std::log(priors.none)}};
    for (int a = 0; a < k; ++a) list.push_back({{a}, false, name(a), std::log(priors.single * weight(a) / singles)});
    for (int a = 0; a < k; ++a)
        for (int b = a + 1; b < k; ++b) list.push_back({{a, b}, false, name(a) + " + " + name(b), std::log(priors.pair * weight(a) * weight(b) / pairs)});
    list.push_back({{}, true, "none of these", std::log(priors.open)});
    double sum = 0.0;  // classes that are empty (no pair of one effect) leave their mass to the others
    for (const Hypothesis& h : list) sum += std::exp(h.log_prior);
    for (Hypothesis& h : list) h.log_prior -= std::log(sum);
    return list;
}

Attributor::Attributor(const Problem& problem, const Priors& priors) : problem_(&problem), priors_(priors), hypotheses_(make_hypotheses(problem, priors)) {
    const auto& basis = problem.model->emulator.basis();
    mean_ = problem.fitted.from_outputs * basis.mean;
    modes_ = problem.fitted.from_outputs * basis.modes;
    all_rows_.resize(static_cast<std::size_t>(data()));
    std::iota(all_rows_.begin(), all_rows_.end(), 0);
    const Eigen::VectorXd centre = 0.5 * (problem.phi_lower + problem.phi_upper);
    rough_ = inference::Whitener(covariance(problem, problem.fitted, centre, Eigen::VectorXd::Zero(problem.model->effects())));
    for (const Hypothesis& h : hypotheses_) {
        Cloud cloud;
        if (h.open) {
            clouds_.push_back(cloud);
            continue;
        }
        const auto p = problem.phi_lower.size();
        const auto n = p + static_cast<Eigen::Index>(h.effects.size());
        cloud.prediction.resize(data(), cloud_size);
        for (int i = 0; i < cloud_size; ++i) {
            const Eigen::VectorXd u = inference::halton(static_cast<std::uint64_t>(i) + 1, static_cast<int>(n));
            Eigen::VectorXd psi(n);
            psi.head(p) = problem.phi_lower + u.head(p).cwiseProduct(problem.phi_upper - problem.phi_lower);
            for (Eigen::Index e = p; e < n; ++e) {
                const CampaignEffect& effect = problem.model->effect(h.effects[static_cast<std::size_t>(e - p)]);
                psi[e] = effect.two_sided ? 2.0 * u[e] - 1.0 : u[e];
            }
            cloud.psi.push_back(psi);
            cloud.prediction.col(i) = mean(h, psi);
        }
        clouds_.push_back(std::move(cloud));
    }
}

void Attributor::split(const Hypothesis& h, const Eigen::VectorXd& psi, Eigen::VectorXd& phi, Eigen::VectorXd& theta) const {
    const Eigen::Index p = problem_->phi_lower.size();
    phi = psi.head(p);
    theta = Eigen::VectorXd::Zero(problem_->model->effects());
    for (std::size_t e = 0; e < h.effects.size(); ++e) theta[h.effects[e]] = psi[p + static_cast<Eigen::Index>(e)];
}

Eigen::VectorXd Attributor::mean(const Hypothesis& h, const Eigen::VectorXd& psi) const {
    Eigen::VectorXd phi, theta;
    split(h, psi, phi, theta);
    return mean_ + modes_ * problem_->model->emulator.scores(phi, theta);
}

Eigen::MatrixXd Attributor::covariance_at(const Hypothesis& h, const Eigen::VectorXd& psi, const std::vector<int>& rows) const {
    Eigen::VectorXd phi, theta;
    split(h, psi, phi, theta);
    const Eigen::MatrixXd full = covariance(*problem_, problem_->fitted, phi, theta);
    return rows.size() == all_rows_.size() ? full : Eigen::MatrixXd(full(rows, rows));
}

inference::Inference Attributor::inference_of(const Hypothesis& h, const Eigen::VectorXd& y, const inference::Whitener& whitener,
                                              const std::vector<int>& rows) const {
    inference::Inference problem;
    problem.whitened_data = whitener.whiten(y(rows));
    problem.log_determinant = whitener.log_determinant();
    problem.nu = problem_->model->emulator.nu();
    const Eigen::VectorXd offset = whitener.whiten(mean_(rows));
    const Eigen::MatrixXd modes = whitener.whiten_columns(modes_(rows, Eigen::all));
    problem.whitened_mean = [this, h, offset, modes](const Eigen::VectorXd& psi) {
        Eigen::VectorXd phi, theta;
        split(h, psi, phi, theta);
        return Eigen::VectorXd(offset + modes * problem_->model->emulator.scores(phi, theta));
    };
    const Eigen::Index p = problem_->phi_lower.size(), n = p + static_cast<Eigen::Index>(h.effects.size());
    problem.lower.resize(n);
    problem.upper.resize(n);
    problem.prior_deviation = Eigen::VectorXd::Constant(n, infinity);
    problem.lower.head(p) = problem_->phi_lower;
    problem.upper.head(p) = problem_->phi_upper;
    for (Eigen::Index e = p; e < n; ++e) {
        const CampaignEffect& effect = problem_->model->effect(h.effects[static_cast<std::size_t>(e - p)]);
        problem.lower[e] = effect.two_sided ? -1.0 : 0.0;
        problem.upper[e] = 1.0;
        problem.prior_deviation[e] = priors_.amplitude;
    }
    return problem;
}

Fit Attributor::fit_closed(std::size_t index, const Eigen::VectorXd& y, const std::vector<int>& rows, bool sample) const {
    const Hypothesis& h = hypotheses_[index];
    const Cloud& cloud = clouds_[index];
    // The two best points of the cloud, judged with one covariance for all.
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < cloud.psi.size(); ++i) {
        const Eigen::VectorXd r = y - cloud.prediction.col(static_cast<Eigen::Index>(i));
        order.emplace_back(rough_.whiten(r).squaredNorm(), i);
    }
    std::sort(order.begin(), order.end());
    Fit fit;
    fit.whitener = inference::Whitener(covariance_at(h, cloud.psi[order[0].second], rows));
    fit.mode = inference::find_mode(inference_of(h, y, fit.whitener, rows), {cloud.psi[order[0].second], cloud.psi[order[1].second]}, 10);
    inference::Inference problem;
    for (int pass = 0; pass < 2; ++pass) {  // Σ at the mode, and the mode with that Σ
        fit.whitener = inference::Whitener(covariance_at(h, fit.mode.psi, rows));
        problem = inference_of(h, y, fit.whitener, rows);
        fit.mode = inference::find_mode(problem, {fit.mode.psi}, 6);
    }
    if (!sample) {
        fit.log_evidence = inference::laplace_evidence(problem, fit.mode);
        return fit;
    }
    inference::SamplingOptions options;
    options.draws = 32;  // «where» counts them
    fit.posterior = inference::sample_posterior(problem, fit.mode, options);
    fit.log_evidence = fit.posterior.log_evidence;
    return fit;
}

/// y = f(φ, 0) + δ, δ = Σ a_j b_j, a ~ N(0, τ²), τ log-uniform on [0.5, 20]. Σ is that of the best explanation with at most one effect: a reality with an
/// unknown effect scatters, and is emulated, as badly as one with a known one. With Σ at θ = 0 the open class would win by its smaller determinant alone.
Fit Attributor::fit_open(const Eigen::VectorXd& y) const {
    const Fit base = fit_closed(0, y, all_rows_, false);
    Fit best_closed = base;
    for (std::size_t h = 1; h < hypotheses_.size(); ++h) {
        if (hypotheses_[h].open || hypotheses_[h].effects.size() != 1) continue;
        Fit one = fit_closed(h, y, all_rows_, false);
        if (one.log_evidence > best_closed.log_evidence) best_closed = std::move(one);
    }
    const Eigen::MatrixXd sigma = best_closed.whitener.factor() * best_closed.whitener.factor().transpose();
    const Distortions d = generic_distortions(*problem_, sigma.diagonal().cwiseSqrt());
    constexpr int nodes = 6;
    std::vector<Fit> fits;
    Eigen::VectorXd start = base.mode.psi;
    double largest = -infinity;
    for (int i = 0; i < nodes; ++i) {
        const double tau = 0.5 * std::pow(40.0, (i + 0.5) / nodes);
        Fit one;
        one.distortion = tau * d.shapes;
        one.whitener = inference::Whitener(sigma + one.distortion * one.distortion.transpose());
        const auto problem = inference_of(hypotheses_[0], y, one.whitener, all_rows_);
        one.mode = inference::find_mode(problem, {start}, 6);
        start = one.mode.psi;
        inference::SamplingOptions options;
        options.samples = 64;
        options.rounds = 1;
        one.posterior = inference::sample_posterior(problem, one.mode, options);
        one.log_evidence = one.posterior.log_evidence;
        largest = std::max(largest, one.log_evidence);
        fits.push_back(std::move(one));
    }
    double sum = 0.0;
    std::size_t best = 0;
    for (std::size_t i = 0; i < fits.size(); ++i) {
        sum += std::exp(fits[i].log_evidence - largest) / nodes;
        if (fits[i].log_evidence > fits[best].log_evidence) best = i;
    }
    Fit fit = fits[best];
    fit.log_evidence = largest + std::log(sum);
    return fit;
}

Fit Attributor::fit(std::size_t hypothesis, const Eigen::VectorXd& y, bool sample) const {
    return hypotheses_[hypothesis].open ? fit_open(y) : fit_closed(hypothesis, y, all_rows_, sample);
}

Fit Attributor::fit_rows(std::size_t hypothesis, const Eigen::VectorXd& y, const std::vector<int>& rows) const {
    return fit_closed(hypothesis, y, rows, false);
}

}  // namespace pelletlab::diagnosis
