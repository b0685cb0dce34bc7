#include "inference/emulator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::inference {
namespace {

SpokeInputs spokes(int base, int each, int effects) {
    SpokeInputs x;
    const int n = base + each * effects;
    x.phi.resize(n, 2);
    x.theta = Eigen::MatrixXd::Zero(n, effects);
    x.scatter = Eigen::VectorXd::Ones(n);
    for (int i = 0; i < n; ++i) {
        x.phi.row(i) = halton(static_cast<std::uint64_t>(i) + 1, 2).transpose();
        if (i >= base) x.theta(i, (i - base) / each) = 0.1 + 0.9 * ((i - base) % each + 0.5) / each;
    }
    return x;
}

double response(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) {
    return 1.0 + 2.0 * phi[0] - phi[1] * phi[1] + (1.5 + phi[0]) * theta[0] + 0.8 * std::sin(2.0 * theta[1]);
}

TEST(SpokeKernel, DerivativesAgreeWithDifferences) {
    const SpokeInputs x = spokes(5, 4, 2);
    const SpokeLayout layout{2, 2};
    Eigen::VectorXd logs = layout.prior_mean();
    for (Eigen::Index i = 0; i < logs.size(); ++i) logs[i] += 0.1 * static_cast<double>(i % 3);
    std::vector<Eigen::MatrixXd> derivatives;
    spoke_covariance(layout, logs, x, &derivatives);
    for (Eigen::Index i = 0; i < logs.size(); ++i) {
        Eigen::VectorXd up = logs, down = logs;
        up[i] += 1e-5;
        down[i] -= 1e-5;
        const Eigen::MatrixXd numeric = (spoke_covariance(layout, up, x) - spoke_covariance(layout, down, x)) / 2e-5;
        EXPECT_LT((numeric - derivatives[static_cast<std::size_t>(i)]).cwiseAbs().maxCoeff(), 1e-7) << "logarithm " << i;
    }
}

TEST(SpokeKernel, EvaluatorAndMatrixAgreeAndZeroAmplitudeIsTheBaselineBitForBit) {
    const SpokeInputs x = spokes(6, 5, 2);
    const SpokeLayout layout{2, 2};
    const Eigen::VectorXd logs = layout.prior_mean();
    const SpokeEvaluator kernel(layout, logs, x);
    const Eigen::MatrixXd matrix = spoke_covariance(layout, logs, x);
    for (Eigen::Index i = 0; i < x.runs(); ++i) {
        Eigen::VectorXd column = kernel.covariances(x.phi.row(i).transpose(), x.theta.row(i).transpose()).matrix();
        column[i] += kernel.noise();
        EXPECT_LT((column - matrix.col(i)).cwiseAbs().maxCoeff(), 1e-10);
        EXPECT_NEAR(kernel.variance(x.phi.row(i).transpose(), x.theta.row(i).transpose()) + kernel.noise(), matrix(i, i), 1e-10);
    }
    // The covariance of any θ = 0 point with a spoke run is that of the two baselines: the effect's own part is exactly zero.
    const Eigen::Vector2d phi(0.3, 0.6), none(0.0, 0.0);
    SpokeInputs bare = x;
    bare.theta.setZero();
    const Eigen::ArrayXd with = kernel.covariances(phi, none), without = SpokeEvaluator(layout, logs, bare).covariances(phi, none);
    for (Eigen::Index i = 0; i < x.runs(); ++i) EXPECT_EQ(with[i], without[i]);
}

TEST(GaussianProcess, LearnsASmoothResponseAndItsNoise) {
    const SpokeInputs x = spokes(30, 14, 2);
    RandomStream random(4, 1);
    Eigen::VectorXd y(x.runs());
    for (Eigen::Index i = 0; i < x.runs(); ++i) y[i] = response(x.phi.row(i).transpose(), x.theta.row(i).transpose()) + 0.05 * random.normal();
    std::vector<int> all(static_cast<std::size_t>(x.runs()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    const GaussianProcess gp(x, y, all, {});
    double worst = 0.0;
    for (std::uint64_t i = 100; i < 140; ++i) {
        const Eigen::VectorXd phi = halton(i, 2).array() * 0.9 + 0.05;
        Eigen::VectorXd theta = Eigen::VectorXd::Zero(2);
        theta[static_cast<Eigen::Index>(i % 2)] = 0.8;
        worst = std::max(worst, std::abs(gp.mean(phi, theta) - response(phi, theta)));
    }
    EXPECT_LT(worst, 0.15);  // three times the noise of one run
    EXPECT_NEAR(std::sqrt(gp.noise_variance()), 0.05, 0.02);

    // Leave-one-out by the closed form against a process that never saw the run (same numbers of the kernel are not refitted, so compare loosely in size only).
    std::vector<int> group(all.begin(), all.end());
    const auto left = gp.leave_groups_out(group);
    double z = 0.0;
    for (Eigen::Index i = 0; i < x.runs(); ++i) z += std::pow(left.error[i] / left.deviation[i], 2) / static_cast<double>(x.runs());
    EXPECT_NEAR(std::sqrt(z), 1.0, 0.35);
}

TEST(Emulator, IsTheSameForAnyNumberOfThreadsAndRefusesTooFewRuns) {
    const SpokeInputs x = spokes(20, 8, 2);
    TrainingRuns runs;
    runs.inputs = x;
    runs.output.resize(x.runs(), 4);
    RandomStream random(5, 2);
    for (Eigen::Index i = 0; i < x.runs(); ++i) {
        const double r = response(x.phi.row(i).transpose(), x.theta.row(i).transpose());
        for (int j = 0; j < 4; ++j) runs.output(i, j) = r * (1 + 0.3 * j) + j * x.phi(i, 1) + 0.05 * random.normal();
        runs.point.push_back(static_cast<int>(i));
    }
    const Eigen::VectorXd weight = Eigen::VectorXd::Constant(4, 5.0);
    const Eigen::Vector2d phi(0.4, 0.4), theta(0.5, 0.0);
    set_thread_count(1);
    const Emulator one(runs, weight);
    set_thread_count(2);
    const Emulator two(runs, weight);
    const Eigen::VectorXd a = one.field(phi, theta), b = two.field(phi, theta);
    for (int j = 0; j < 4; ++j) EXPECT_EQ(a[j], b[j]);
    EXPECT_TRUE(one.score_covariance(phi, theta, true).isApprox(two.score_covariance(phi, theta, true), 0.0));
    EXPECT_NEAR(a[0], response(phi, theta), 0.15);
    runs.inputs = x.rows({0, 1, 2, 3});
    runs.output = Eigen::MatrixXd(runs.output.topRows(4));
    EXPECT_THROW(Emulator(runs, weight), std::runtime_error);
}

}  // namespace
}  // namespace pelletlab::inference
