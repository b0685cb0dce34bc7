// Minimum of a smooth function with its gradient: BFGS with backtracking, for the few numbers of an emulator.
#pragma once

#include <functional>

#include "core/vec.hpp"

namespace pelletlab::inference {

struct Minimum {
    Eigen::VectorXd x;
    double value = 0.0;
    int evaluations = 0;
};

/// f(x, gradient) fills the gradient; a value that is not finite counts as «too far». Stops when a step gains less than `tolerance` or after `largest_count`
/// evaluations: a result that is not fully converged is still the best point seen.
Minimum minimise(const std::function<double(const Eigen::VectorXd&, Eigen::VectorXd&)>& f, const Eigen::VectorXd& start, double tolerance, int largest_count);

}  // namespace pelletlab::inference
