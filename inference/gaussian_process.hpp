// One number as a Gaussian process over parameters and effects: fit of the kernel's numbers, mean, variance, and exact leave-group-out errors.
#pragma once

#include <vector>

#include "inference/spoke_kernel.hpp"

namespace pelletlab::inference {

class GaussianProcess {
public:
    GaussianProcess() = default;
    /// Maximum a posteriori numbers of the kernel from the runs with at most one effect; with `pairs` (indices of further runs with several effects) the
    /// interaction and the noise are fitted again on all of them. `y` is scaled to unit variance inside.
    GaussianProcess(const SpokeInputs& x, const Eigen::VectorXd& y, const std::vector<int>& spokes, const std::vector<int>& pairs);

    double mean(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const;
    /// Variance of the mean response (without the scatter of one run), and of the scatter of a run whose relative scatter is 1.
    double variance(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const;
    double noise_variance() const { return scale_ * scale_ * kernel_.noise(); }

    /// Errors y − prediction from all runs of other groups, and their predicted standard deviations (scatter of one run included).
    struct LeftOut {
        Eigen::VectorXd error, deviation;
    };
    LeftOut leave_groups_out(const std::vector<int>& group) const;
    /// The process with the same numbers of the kernel that never saw these runs (numbers in its own order: spokes, then pairs).
    GaussianProcess without(const std::vector<int>& runs) const;
    const Eigen::VectorXd& logs() const { return logs_; }

private:
    void condition();  ///< on x_ and y_ with the numbers in logs_
    SpokeLayout layout_;
    SpokeInputs x_;
    SpokeEvaluator kernel_;
    Eigen::VectorXd logs_, alpha_, y_;
    Eigen::MatrixXd factor_;
    double offset_ = 0.0, scale_ = 1.0;
};

}  // namespace pelletlab::inference
