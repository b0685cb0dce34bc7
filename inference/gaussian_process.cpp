#include "inference/gaussian_process.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.hpp"
#include "inference/minimise.hpp"

namespace pelletlab::inference {

namespace {

/// Negative log posterior of the logarithms: ½ yᵀK⁻¹y + ½ ln|K| + ½ Σ ((h − m)/w)². Fills the gradient ½ tr((K⁻¹ − ααᵀ) ∂K).
double objective(const SpokeLayout& layout, const SpokeInputs& x, const Eigen::VectorXd& y, const Eigen::VectorXd& logs, Eigen::VectorXd& gradient) {
    std::vector<Eigen::MatrixXd> derivatives;
    const Eigen::MatrixXd covariance = spoke_covariance(layout, logs, x, &derivatives);
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    const Eigen::VectorXd alpha = llt.solve(y);
    const Eigen::MatrixXd inverse = llt.solve(Eigen::MatrixXd::Identity(x.runs(), x.runs()));
    const Eigen::MatrixXd w = inverse - alpha * alpha.transpose();
    const Eigen::VectorXd pull = (logs - layout.prior_mean()).cwiseQuotient(layout.prior_width());
    for (Eigen::Index i = 0; i < layout.size(); ++i)
        gradient[i] = 0.5 * (w.array() * derivatives[static_cast<std::size_t>(i)].array()).sum() + pull[i] / layout.prior_width()[i];
    const Eigen::MatrixXd& l = llt.matrixLLT();
    return 0.5 * y.dot(alpha) + l.diagonal().array().log().sum() + 0.5 * pull.squaredNorm();
}

/// Interaction and noise alone, on a coarse grid of logarithms: two numbers do not need a gradient of thousands of pairs.
Eigen::VectorXd fit_interaction(const SpokeLayout& layout, const SpokeInputs& x, const Eigen::VectorXd& y, Eigen::VectorXd logs) {
    const Eigen::VectorXd mean = layout.prior_mean(), width = layout.prior_width();
    const auto value_at = [&](const Eigen::VectorXd& at) {
        const Eigen::LLT<Eigen::MatrixXd> llt(spoke_covariance(layout, at, x));
        if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
        return 0.5 * y.dot(llt.solve(y)) + llt.matrixLLT().diagonal().array().log().sum() + 0.5 * (at - mean).cwiseQuotient(width).squaredNorm();
    };
    double best = value_at(logs);
    for (double step = 2.0; step > 0.2; step *= 0.5)
        for (const Eigen::Index i : {layout.pair(), layout.noise()})
            for (int round = 0; round < 4; ++round) {
                bool better = false;
                for (const double sign : {-1.0, 1.0}) {
                    Eigen::VectorXd trial = logs;
                    trial[i] += sign * step;
                    const double value = value_at(trial);
                    if (value < best) {
                        best = value;
                        logs = trial;
                        better = true;
                        break;
                    }
                }
                if (!better) break;
            }
    return logs;
}

}  // namespace

GaussianProcess::GaussianProcess(const SpokeInputs& x, const Eigen::VectorXd& y, const std::vector<int>& spokes, const std::vector<int>& pairs)
    : layout_{x.phi.cols(), x.theta.cols()} {
    std::vector<int> all = spokes;
    all.insert(all.end(), pairs.begin(), pairs.end());
    x_ = x.rows(all);
    y_ = y(all);
    offset_ = y_.mean();
    scale_ = std::max(1e-300, std::sqrt((y_.array() - offset_).square().mean()));
    y_ = (y_.array() - offset_) / scale_;

    const SpokeInputs spoke_inputs = x.rows(spokes);
    const Eigen::VectorXd spoke_y = y_.head(static_cast<Eigen::Index>(spokes.size()));
    const auto f = [&](const Eigen::VectorXd& logs, Eigen::VectorXd& gradient) { return objective(layout_, spoke_inputs, spoke_y, logs, gradient); };
    logs_ = minimise(f, layout_.prior_mean(), 0.02, 60).x;
    if (!pairs.empty()) logs_ = fit_interaction(layout_, x_, y_, logs_);

    condition();
}

void GaussianProcess::condition() {
    const Eigen::LLT<Eigen::MatrixXd> llt(spoke_covariance(layout_, logs_, x_));
    if (llt.info() != Eigen::Success)
        throw numerical_failure("the emulator's covariance is singular", "check the campaign for equal runs with different results");
    factor_ = llt.matrixL();
    alpha_ = llt.solve(y_);
    kernel_ = SpokeEvaluator(layout_, logs_, x_);
}

GaussianProcess GaussianProcess::without(const std::vector<int>& runs) const {
    std::vector<bool> out(static_cast<std::size_t>(x_.runs()), false);
    for (const int i : runs) out[static_cast<std::size_t>(i)] = true;
    std::vector<int> kept;
    for (std::size_t i = 0; i < out.size(); ++i)
        if (!out[i]) kept.push_back(static_cast<int>(i));
    GaussianProcess rest = *this;
    rest.x_ = x_.rows(kept);
    rest.y_ = y_(kept);
    rest.condition();
    return rest;
}

double GaussianProcess::mean(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const {
    return offset_ + scale_ * kernel_.covariances(phi, theta).matrix().dot(alpha_);
}

double GaussianProcess::variance(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const {
    const Eigen::VectorXd half = factor_.triangularView<Eigen::Lower>().solve(kernel_.covariances(phi, theta).matrix());
    return scale_ * scale_ * std::max(0.0, kernel_.variance(phi, theta) - half.squaredNorm());
}

GaussianProcess::LeftOut GaussianProcess::leave_groups_out(const std::vector<int>& group) const {
    const Eigen::MatrixXd half = factor_.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(x_.runs(), x_.runs()));
    const Eigen::MatrixXd inverse = half.transpose() * half;
    std::map<int, std::vector<int>> members;
    for (std::size_t i = 0; i < group.size(); ++i) members[group[i]].push_back(static_cast<int>(i));
    LeftOut out{Eigen::VectorXd(x_.runs()), Eigen::VectorXd(x_.runs())};
    for (const auto& [name, list] : members) {
        const Eigen::LLT<Eigen::MatrixXd> block{Eigen::MatrixXd(inverse(list, list))};
        const Eigen::VectorXd error = block.solve(Eigen::VectorXd(alpha_(list)));
        const Eigen::MatrixXd covariance = block.solve(Eigen::MatrixXd::Identity(error.size(), error.size()));
        for (std::size_t i = 0; i < list.size(); ++i) {
            out.error[list[i]] = scale_ * error[static_cast<Eigen::Index>(i)];
            out.deviation[list[i]] = scale_ * std::sqrt(covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
        }
    }
    return out;
}

}  // namespace pelletlab::inference
