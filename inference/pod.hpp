// Proper orthogonal decomposition of a campaign's outputs: few scores instead of many correlated numbers.
#pragma once

#include "core/vec.hpp"

namespace pelletlab::inference {

/// y = mean + modes · scores + what is left. Modes are orthonormal in the metric of the weights: Mᵀ diag(w²) M = 1.
struct PodBasis {
    Eigen::VectorXd mean, weight;
    Eigen::MatrixXd modes;           ///< outputs × modes, in the outputs' units
    Eigen::VectorXd singular_share;  ///< share of the weighted variance in each mode
    double kept = 0.0;               ///< share of the weighted variance in all modes

    Eigen::VectorXd scores(const Eigen::VectorXd& y) const;
    Eigen::VectorXd field(const Eigen::VectorXd& scores) const { return mean + modes * scores; }
    /// What no mode can make: y − field(scores(y)).
    Eigen::VectorXd residual(const Eigen::VectorXd& y) const { return y - field(scores(y)); }
};

/// Rows of `outputs` are runs; weight[j] = 1 / (scale that matters of output j). Keeps the fewest modes with `keep` of the weighted variance, at most
/// `largest`.
PodBasis make_pod(const Eigen::MatrixXd& outputs, const Eigen::VectorXd& weight, double keep, int largest);

}  // namespace pelletlab::inference
