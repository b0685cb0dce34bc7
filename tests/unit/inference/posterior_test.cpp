#include "inference/posterior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pelletlab::inference {
namespace {

const double infinity = std::numeric_limits<double>::infinity();

/// y = A ψ + noise with unit covariance: everything is known in closed form.
struct Linear {
    Eigen::MatrixXd a = (Eigen::MatrixXd(5, 2) << 1, 0.5, -0.3, 1, 2, 0.1, 0.4, -1, 0.7, 0.7).finished();
    Eigen::VectorXd y = (Eigen::VectorXd(5) << 1.2, -0.4, 2.5, 0.9, 0.3).finished();
    double sd = 0.8;

    Inference problem() const {
        Inference p;
        p.whitened_data = y;
        p.nu = infinity;
        p.whitened_mean = [a = a](const Eigen::VectorXd& psi) { return Eigen::VectorXd(a * psi); };
        p.lower = Eigen::VectorXd::Constant(2, -20.0);
        p.upper = Eigen::VectorXd::Constant(2, 20.0);
        p.prior_deviation = Eigen::VectorXd::Constant(2, sd);
        return p;
    }
    Eigen::MatrixXd precision() const { return a.transpose() * a + Eigen::MatrixXd::Identity(2, 2) / (sd * sd); }
};

TEST(Posterior, ModeAndEvidenceOfTheLinearGaussianCase) {
    const Linear l;
    const Inference p = l.problem();
    const Mode mode = find_mode(p, {Eigen::VectorXd::Constant(2, 3.0)});
    const Eigen::VectorXd exact = l.precision().ldlt().solve(l.a.transpose() * l.y);
    EXPECT_LT((mode.psi - exact).norm(), 1e-4);
    // evidence: y ~ N(0, 1 + sd² A Aᵀ)
    const Whitener marginal(Eigen::MatrixXd::Identity(5, 5) + l.sd * l.sd * l.a * l.a.transpose());
    const double evidence = log_student_density(marginal.whiten(l.y).squaredNorm(), 5, marginal.log_determinant(), infinity);
    EXPECT_NEAR(laplace_evidence(p, mode), evidence, 0.01);  // the box floor of the precision costs less than that
    SamplingOptions options;
    options.samples = 4000;
    const Posterior posterior = sample_posterior(p, mode, options);
    EXPECT_NEAR(posterior.log_evidence, evidence, 0.05);  // 4000 samples: standard error about 0.01
    EXPECT_GT(posterior.effective_samples, 1000);
    const Eigen::MatrixXd covariance = l.precision().inverse();
    for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(posterior.mean[i], exact[i], 0.06 * std::sqrt(covariance(i, i)));
        EXPECT_NEAR(posterior.deviation[i], std::sqrt(covariance(i, i)), 0.06 * std::sqrt(covariance(i, i)));
        EXPECT_NEAR(posterior.upper[i] - posterior.lower[i], 2 * 1.6449 * std::sqrt(covariance(i, i)), 0.12 * std::sqrt(covariance(i, i)) * 3.3);
    }
}

TEST(Posterior, ResidualOperatorTakesOutWhatTheFitAbsorbsWhateverTheMisfit) {
    const Linear l;
    Inference p = l.problem();
    p.prior_deviation.setConstant(infinity);
    p.nu = 4.0;
    p.lower.setConstant(-200.0);
    p.upper.setConstant(200.0);
    const Eigen::MatrixXd exact = Eigen::MatrixXd::Identity(5, 5) - l.a * (l.a.transpose() * l.a).ldlt().solve(l.a.transpose());
    for (const double size : {1.0, 12.0}) {  // the data fit well; the data do not fit at all and the heavy tail weighs them down
        p.whitened_data = size * l.y;
        const Mode mode = find_mode(p, {Eigen::VectorXd::Zero(2)}, 30);
        EXPECT_EQ(mode.free, (std::vector<int>{0, 1}));
        if (size > 1.0) {
            EXPECT_LT(mode.weight, 0.5);
        }
        EXPECT_LT((residual_operator(mode) - exact).cwiseAbs().maxCoeff(), 1e-3);  // the precision's floor: as wide as the box
        EXPECT_LT((residual_operator(mode) * p.whitened_data - mode.residual).norm(), 1e-2 * mode.residual.norm());
    }
    // An unknown that a bound holds absorbs nothing.
    p.whitened_data = l.y;
    const double free_value = (l.a.transpose() * l.a).ldlt().solve(l.a.transpose() * l.y)[0];
    p.lower[0] = free_value + 0.5;
    const Mode held = find_mode(p, {Eigen::VectorXd::Constant(2, 3.0)}, 30);
    EXPECT_EQ(held.free, std::vector<int>{1});
    const Eigen::VectorXd second = l.a.col(1);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(5, 5) - second * second.transpose() / second.squaredNorm();
    EXPECT_LT((residual_operator(held) - one).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Posterior, ABoundCutsPriorAndPosterior) {
    Linear l;
    Inference p = l.problem();
    p.lower.setZero();  // half-normal prior
    EXPECT_NEAR(log_prior(p, Eigen::Vector2d(0.3, 0.2)), 2 * std::log(2.0) - 0.5 * (0.09 + 0.04) / (l.sd * l.sd) - std::log(2 * M_PI * l.sd * l.sd), 1e-12);
    EXPECT_EQ(log_prior(p, Eigen::Vector2d(-0.1, 0.2)), -infinity);
    // One unknown, half-normal, the maximum at the bound: evidence by Simpson's rule.
    Inference one = p;
    one.lower = Eigen::VectorXd::Zero(1);
    one.upper = Eigen::VectorXd::Constant(1, 1.0);
    one.prior_deviation = Eigen::VectorXd::Constant(1, 0.5);
    one.whitened_mean = [](const Eigen::VectorXd& psi) { return Eigen::VectorXd(Eigen::VectorXd::Constant(5, 1.0) * psi[0]); };
    one.whitened_data = Eigen::VectorXd::Constant(5, -0.3);
    double integral = 0.0;
    constexpr int n = 2000;
    for (int i = 0; i <= n; ++i) {
        const Eigen::VectorXd psi = Eigen::VectorXd::Constant(1, static_cast<double>(i) / n);
        const double f = std::exp(log_prior(one, psi) + log_student_density((one.whitened_data - one.whitened_mean(psi)).squaredNorm(), 5, 0.0, infinity));
        integral += f * (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) / (3.0 * n);
    }
    SamplingOptions options;
    options.samples = 4000;
    const Posterior posterior = sample_posterior(one, find_mode(one, {Eigen::VectorXd::Constant(1, 0.5)}), options);
    EXPECT_DOUBLE_EQ(posterior.mode.psi[0], 0.0);
    EXPECT_NEAR(posterior.log_evidence, std::log(integral), 0.05);
}

TEST(Posterior, ProfileLikelihoodOfTheLinearCaseIsAParabola) {
    const Linear l;
    Inference p = l.problem();
    p.prior_deviation.setConstant(infinity);
    const Eigen::VectorXd best = (l.a.transpose() * l.a).ldlt().solve(l.a.transpose() * l.y);
    const double variance = (l.a.transpose() * l.a).inverse()(0, 0), least = (l.y - l.a * best).squaredNorm();
    const auto profile = profile_chi2(p, 0, {best[0] - 1.0, best[0], best[0] + 2.0}, best);
    EXPECT_NEAR(profile[0] - least, 1.0 / variance, 1e-3 / variance);
    EXPECT_NEAR(profile[1] - least, 0.0, 1e-6);
    EXPECT_NEAR(profile[2] - least, 4.0 / variance, 4e-3 / variance);
}

}  // namespace
}  // namespace pelletlab::inference
