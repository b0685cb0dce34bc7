// How the scatter of single runs changes over parameters and effects: the logarithm of the variance is linear in
// x = (1, φ_i, φ_i², |θ_k|, Σ_{k<l} |θ_k θ_l|).
#pragma once

#include <vector>

#include "inference/spoke_kernel.hpp"

namespace pelletlab::inference {

struct ScatterModel {
    Eigen::VectorXd coefficients;  ///< β, one for each element of x
    double nu = 200.0;             ///< degrees of freedom of the Student t about it
    /// Variance factor exp(β·x).
    double factor(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const;
    /// The same without the constant: relative to the middle of the runs it was fitted to.
    double relative(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const;
    double middle = 0.0;  ///< mean of β·x over those runs
};

/// Most likely β and ν (from 4 to 200) when run i has Mahalanobis distance `distance[i]` in `dimensions` dimensions under a unit variance factor:
/// Student-t likelihood, normal prior on the slopes.
struct ScatterOptions {
    double width = 1.5;   ///< of the prior on the slopes
    double weight = 1.0;  ///< of one run's likelihood, below 1 where runs share their errors
    bool normal = false;  ///< ν = 200 only
};
ScatterModel fit_scatter(const SpokeInputs& runs, const std::vector<double>& distance, Eigen::Index dimensions, const ScatterOptions& options = {});

}  // namespace pelletlab::inference
