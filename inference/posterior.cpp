#include "inference/posterior.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <numbers>

#include "inference/statistics.hpp"

namespace pelletlab::inference {

namespace {

double weight_of(const Inference& p, double chi2) {
    return heavy_tailed_weight(chi2, p.whitened_data.size(), p.nu);
}

double log_likelihood(const Inference& p, double chi2) {
    return log_heavy_tailed_likelihood(chi2, p.whitened_data.size(), p.log_determinant, p.nu);
}

Eigen::VectorXd clamped(const Inference& p, const Eigen::VectorXd& psi) {
    return psi.cwiseMax(p.lower).cwiseMin(p.upper);
}

Eigen::VectorXd prior_precision(const Inference& p) {
    return p.prior_deviation.array().inverse().square();  // 1/∞² = 0
}

Eigen::MatrixXd jacobian_at(const Inference& p, const Eigen::VectorXd& psi, const Eigen::VectorXd& f) {
    Eigen::MatrixXd j(f.size(), psi.size());
    for (Eigen::Index i = 0; i < psi.size(); ++i) {
        const double range = p.upper[i] - p.lower[i];
        const double step = (psi[i] + 2e-4 * range > p.upper[i] ? -2e-4 : 2e-4) * range;
        Eigen::VectorXd moved = psi;
        moved[i] += step;
        j.col(i) = (p.whitened_mean(moved) - f) / step;
    }
    return j;
}

double log_unnormalised(const Inference& p, const Eigen::VectorXd& psi, double chi2) {
    return log_likelihood(p, chi2) - 0.5 * psi.cwiseAbs2().dot(prior_precision(p));
}

/// Gradient of the log posterior at a mode whose residual and χ² are known.
Eigen::VectorXd slope(const Inference& p, const Eigen::MatrixXd& jacobian, const Mode& m) {
    return weight_of(p, m.chi2) * jacobian.transpose() * m.residual - prior_precision(p).cwiseProduct(m.psi);
}

bool stuck(const Inference& p, const Eigen::VectorXd& psi, const Eigen::VectorXd& g, Eigen::Index i) {
    return (psi[i] <= p.lower[i] && g[i] < 0.0) || (psi[i] >= p.upper[i] && g[i] > 0.0);
}

Mode climb(const Inference& p, const Eigen::VectorXd& start, int largest_steps) {
    Mode m;
    m.psi = clamped(p, start);
    Eigen::VectorXd f = p.whitened_mean(m.psi);
    m.residual = p.whitened_data - f;
    m.chi2 = m.residual.squaredNorm();
    m.log_posterior = log_unnormalised(p, m.psi, m.chi2);
    double damping = 1e-3;
    for (int step = 0; step < largest_steps; ++step) {
        const Eigen::MatrixXd j = jacobian_at(p, m.psi, f);
        Eigen::MatrixXd a = weight_of(p, m.chi2) * j.transpose() * j;
        a.diagonal() += prior_precision(p);
        Eigen::VectorXd g = slope(p, j, m);
        for (Eigen::Index i = 0; i < g.size(); ++i) {  // unknowns that push against the box stay there
            if (!stuck(p, m.psi, g, i)) continue;
            a.row(i).setZero();
            a.col(i).setZero();
            a(i, i) = 1.0;
            g[i] = 0.0;
        }
        bool moved = false;
        double gain = 0.0;
        for (int attempt = 0; attempt < 6 && !moved; ++attempt, damping *= 5.0) {
            Eigen::MatrixXd damped = a;
            damped.diagonal() += damping * a.diagonal() + Eigen::VectorXd::Constant(g.size(), 1e-9);
            const Eigen::VectorXd psi = clamped(p, m.psi + damped.ldlt().solve(g));
            const Eigen::VectorXd trial = p.whitened_mean(psi);
            const Eigen::VectorXd residual = p.whitened_data - trial;
            const double chi2 = residual.squaredNorm(), value = log_unnormalised(p, psi, chi2);
            if (!(value > m.log_posterior)) continue;
            gain = value - m.log_posterior;
            m.psi = psi;
            f = trial;
            m.residual = residual;
            m.chi2 = chi2;
            m.log_posterior = value;
            damping *= 0.02;
            moved = true;
        }
        if (!moved || gain < 1e-4) break;
    }
    return m;
}

}  // namespace

double log_prior(const Inference& p, const Eigen::VectorXd& psi) {
    double value = 0.0;
    for (Eigen::Index i = 0; i < psi.size(); ++i) {
        if (psi[i] < p.lower[i] || psi[i] > p.upper[i]) return -std::numeric_limits<double>::infinity();
        const double sd = p.prior_deviation[i];
        if (!std::isfinite(sd)) {
            value -= std::log(p.upper[i] - p.lower[i]);
            continue;
        }
        const double mass = normal_cdf(p.upper[i] / sd) - normal_cdf(p.lower[i] / sd);
        value -= 0.5 * psi[i] * psi[i] / (sd * sd) + std::log(sd * std::sqrt(2.0 * std::numbers::pi) * mass);
    }
    return value;
}

Mode find_mode(const Inference& p, const std::vector<Eigen::VectorXd>& starts, int largest_steps) {
    Mode best;
    bool first = true;
    for (const Eigen::VectorXd& start : starts) {
        Mode one = climb(p, start, largest_steps);
        if (first || one.log_posterior > best.log_posterior) best = std::move(one);
        first = false;
    }
    best.jacobian = jacobian_at(p, best.psi, p.whitened_data - best.residual);
    best.weight = weight_of(p, best.chi2);
    best.precision = best.weight * best.jacobian.transpose() * best.jacobian;
    // A direction that the data leave free is bounded by the box: a normal as wide as half of it.
    best.precision.diagonal() += prior_precision(p) + (0.5 * (p.upper - p.lower)).array().inverse().square().matrix();
    const Eigen::VectorXd g = slope(p, best.jacobian, best);
    best.free.clear();
    for (Eigen::Index i = 0; i < g.size(); ++i)
        if (!stuck(p, best.psi, g, i)) best.free.push_back(static_cast<int>(i));
    return best;
}

Eigen::MatrixXd residual_operator(const Mode& mode) {
    const Eigen::Index n = mode.residual.size();
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(n, n);
    if (mode.free.empty()) return m;
    const Eigen::MatrixXd j = mode.jacobian(Eigen::all, mode.free);
    const Eigen::MatrixXd precision = mode.precision(mode.free, mode.free);
    m -= mode.weight * j * precision.ldlt().solve(j.transpose());
    return m;
}

double laplace_evidence(const Inference& p, const Mode& mode) {
    const Eigen::LLT<Eigen::MatrixXd> llt(mode.precision);
    const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
    return log_likelihood(p, mode.chi2) + log_prior(p, mode.psi) + 0.5 * static_cast<double>(mode.psi.size()) * std::log(2.0 * std::numbers::pi) -
           0.5 * log_det;
}

namespace {

constexpr double proposal_nu = 5.0;

struct Sample {
    Eigen::VectorXd psi;
    double log_weight;
};

struct Round {
    std::vector<Sample> samples;
    Eigen::VectorXd weight, mean;
    Eigen::MatrixXd covariance;
    double log_evidence = 0.0, effective = 0.0;
};

Round draw_round(const Inference& p, const Eigen::VectorXd& centre, const Eigen::MatrixXd& covariance, int count, RandomStream& random) {
    Round round;
    const Whitener shape(covariance);
    double largest = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i) {
        const Eigen::VectorXd u = draw_student(random, centre.size(), proposal_nu);
        const Eigen::VectorXd psi = centre + shape.colour(u);
        double log_weight = log_prior(p, psi);
        if (std::isfinite(log_weight)) {
            log_weight += log_likelihood(p, (p.whitened_data - p.whitened_mean(psi)).squaredNorm());
            log_weight -= log_student_density(u.squaredNorm(), centre.size(), shape.log_determinant(), proposal_nu);
        }
        largest = std::max(largest, log_weight);
        round.samples.push_back({psi, log_weight});
    }
    round.weight = Eigen::VectorXd::Zero(count);
    round.mean = centre;
    round.covariance = covariance;
    round.log_evidence = -std::numeric_limits<double>::infinity();
    if (!std::isfinite(largest)) return round;
    for (int i = 0; i < count; ++i) round.weight[i] = std::exp(round.samples[static_cast<std::size_t>(i)].log_weight - largest);
    const double sum = round.weight.sum();
    round.log_evidence = largest + std::log(sum / count);
    round.effective = sum * sum / round.weight.squaredNorm();
    round.weight /= sum;
    round.mean.setZero();
    for (int i = 0; i < count; ++i) round.mean += round.weight[i] * round.samples[static_cast<std::size_t>(i)].psi;
    round.covariance.setZero();
    for (int i = 0; i < count; ++i) {
        const Eigen::VectorXd d = round.samples[static_cast<std::size_t>(i)].psi - round.mean;
        round.covariance += round.weight[i] * d * d.transpose();
    }
    return round;
}

}  // namespace

Posterior sample_posterior(const Inference& p, const Mode& mode, const SamplingOptions& options) {
    Posterior posterior;
    posterior.mode = mode;
    const Eigen::Index n = mode.psi.size();
    RandomStream random(options.seed, 0x706f7374);
    const Eigen::MatrixXd laplace = mode.precision.llt().solve(Eigen::MatrixXd::Identity(n, n));
    Round best = draw_round(p, mode.psi, laplace, options.samples, random);
    for (int r = 1; r < options.rounds; ++r) {
        // Moments of few samples are poor: keep a part of the last proposal in the next one.
        const double trust = best.effective / (best.effective + 4.0 * static_cast<double>(n));
        const Eigen::MatrixXd shape = 1.15 * (trust * best.covariance + (1.0 - trust) * laplace);
        const Eigen::VectorXd centre = trust * best.mean + (1.0 - trust) * mode.psi;
        Round next = draw_round(p, centre, shape, options.samples, random);
        if (next.effective >= best.effective) best = std::move(next);
    }
    posterior.log_evidence = best.log_evidence;
    posterior.effective_samples = best.effective;
    posterior.mean = best.mean;
    posterior.deviation = best.covariance.diagonal().cwiseSqrt();
    posterior.lower.resize(n);
    posterior.upper.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        std::vector<std::pair<double, double>> values;
        for (std::size_t s = 0; s < best.samples.size(); ++s) values.emplace_back(best.samples[s].psi[i], best.weight[static_cast<Eigen::Index>(s)]);
        posterior.lower[i] = weighted_quantile(values, 0.05);
        posterior.upper[i] = weighted_quantile(values, 0.95);
    }
    double sum = 0.0;  // systematic resampling
    std::size_t at = 0;
    for (int d = 0; d < options.draws && best.effective > 0.0; ++d) {
        const double target = (d + 0.5) / options.draws;
        while (at + 1 < best.samples.size() && sum + best.weight[static_cast<Eigen::Index>(at)] < target) sum += best.weight[static_cast<Eigen::Index>(at++)];
        posterior.draws.push_back(best.samples[at].psi);
    }
    return posterior;
}

std::vector<double> profile_chi2(const Inference& problem, Eigen::Index i, const std::vector<double>& values, const Eigen::VectorXd& start) {
    std::vector<double> chi2;
    for (const double value : values) {
        Inference fixed = problem;
        Eigen::VectorXd from = start;
        from[i] = value;
        std::vector<Eigen::Index> others;
        for (Eigen::Index j = 0; j < start.size(); ++j)
            if (j != i) others.push_back(j);
        fixed.lower = problem.lower(others);
        fixed.upper = problem.upper(others);
        fixed.prior_deviation = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(others.size()), std::numeric_limits<double>::infinity());
        fixed.whitened_mean = [&](const Eigen::VectorXd& rest) {
            Eigen::VectorXd psi = from;
            for (std::size_t j = 0; j < others.size(); ++j) psi[others[j]] = rest[static_cast<Eigen::Index>(j)];
            return problem.whitened_mean(psi);
        };
        chi2.push_back(others.empty() ? (problem.whitened_data - problem.whitened_mean(from)).squaredNorm()
                                      : find_mode(fixed, {Eigen::VectorXd(from(others))}).chi2);
    }
    return chi2;
}

}  // namespace pelletlab::inference
