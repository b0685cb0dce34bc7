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

    // The closed form of the left-out errors is what a process says that never saw these runs.
    group.assign(all.size(), 0);
    for (std::size_t i = 0; i < all.size(); ++i) group[i] = static_cast<int>(i / 3);
    const auto three = gp.leave_groups_out(group);
    const GaussianProcess rest = gp.without({6, 7, 8});
    for (Eigen::Index i = 6; i < 9; ++i) {
        const Eigen::VectorXd phi = x.phi.row(i).transpose(), theta = x.theta.row(i).transpose();
        EXPECT_NEAR(y[i] - rest.mean(phi, theta), three.error[i], 1e-8);
        EXPECT_NEAR(std::sqrt(rest.variance(phi, theta) + rest.noise_variance()), three.deviation[i], 1e-8);
    }
}

/// A response that bends ten times more at φ_0 = 0 than in the middle, which a kernel with one length for all cannot know; a grid of points, one effect.
struct SteepEdge {
    TrainingRuns runs;
    SteepEdge() {
        const std::vector<double> grid{0.0, 0.25, 0.5, 0.75, 1.0}, amplitude{0.0, 0.3, 0.6, 1.0};
        std::vector<Eigen::Vector3d> rows;
        for (const double a : grid)
            for (const double b : grid)
                for (const double t : amplitude) rows.emplace_back(a, b, t);
        const auto n = static_cast<Eigen::Index>(rows.size());
        runs.inputs.phi.resize(n, 2);
        runs.inputs.theta.resize(n, 1);
        runs.inputs.scatter = Eigen::VectorXd::Ones(n);
        runs.output.resize(n, 6);
        RandomStream random(8, 3);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Eigen::Vector3d& r = rows[static_cast<std::size_t>(i)];
            runs.inputs.phi.row(i) << r[0], r[1];
            runs.inputs.theta(i, 0) = r[2];
            for (int j = 0; j < 6; ++j) runs.output(i, j) = truth(r, j) + 0.01 * random.normal();
            runs.point.push_back(static_cast<int>(i / static_cast<Eigen::Index>(amplitude.size())));
        }
    }
    static double truth(const Eigen::Vector3d& r, int j) {
        const double x = 0.2 * j;
        return (1.0 + x) * std::exp(-4.0 * r[0]) + x * std::sin(3.0 * r[1] + 5.0 * x * std::exp(-4.0 * r[0])) + (0.5 + x * x) * r[2];
    }
    /// Root mean square of (truth − prediction)/(stated deviation) over scores and effects at points that are left out one after the other.
    double honesty(const Emulator& whole, bool at_edge, double& largest_error) const {
        double square = 0.0;
        int count = 0;
        for (int point = 0; point < 25; ++point) {
            const int row = point / 5, column = point % 5;
            const bool edge = row == 0;
            if (edge != at_edge || (!at_edge && (row == 4 || column == 0 || column == 4))) continue;
            const Emulator rest = whole.without_point(point);
            for (int level = 0; level < 4; ++level) {
                const Eigen::Index i = 4 * point + level;
                const Eigen::VectorXd phi = runs.inputs.phi.row(i).transpose(), theta = runs.inputs.theta.row(i).transpose();
                Eigen::VectorXd exact(6);
                for (int j = 0; j < 6; ++j) exact[j] = truth({phi[0], phi[1], theta[0]}, j);
                largest_error = std::max(largest_error, (exact - rest.field(phi, theta)).cwiseAbs().maxCoeff());
                const Eigen::VectorXd error = rest.basis().scores(exact) - rest.scores(phi, theta);
                square += error.cwiseAbs2().cwiseQuotient(rest.score_covariance(phi, theta, true).diagonal()).sum();
                count += static_cast<int>(error.size());
            }
        }
        return std::sqrt(square / count);
    }
};

TEST(Emulator, StatesAnErrorAtTheEdgeThatIsNotSmallerThanItsRealOne) {
    const SteepEdge steep;
    const Emulator emulator(steep.runs, Eigen::VectorXd::Constant(6, 10.0));
    double error_at_edge = 0.0, error_inside = 0.0;
    const double edge = steep.honesty(emulator, true, error_at_edge), inside = steep.honesty(emulator, false, error_inside);
    EXPECT_GT(error_at_edge, 2.0 * error_inside);  // the edge is where it fails
    EXPECT_LT(edge, 1.4);                          // and it says so: 5 points × 4 levels × modes, strongly correlated
    EXPECT_LT(inside, 1.4);
    EXPECT_GT(inside, 0.4);  // without drowning the middle
    EXPECT_NEAR(emulator.report().edge_rms, 1.0, 0.25);
    EXPECT_NEAR(emulator.report().inner_rms, 1.0, 0.35);
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
