// Limited-memory BFGS with a changing metric and lower bounds (Nocedal & Wright 2006, algorithms 7.4 and 7.5; key nocedal2006).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>

namespace pelletlab::shapegen::detail {

struct MinimiserSettings {
    std::uint32_t iterations = 100;
    double tolerance = 1e-4;     ///< ends when three steps in a row gain less than this fraction of the loss
    double longest_step = 0.05;  ///< of any one unknown
    std::size_t memory = 10;
    std::uint32_t metric_every = 3;                                  ///< iterations between two metrics
    double give_up_above = std::numeric_limits<double>::infinity();  ///< ends early when the loss does not look as if it would fall below this
};

struct MinimiserResult {
    double loss = 0.0;
    std::uint32_t iterations = 0;
    bool converged = false;
};

/// Loss and gradient at x; when `refresh_metric` is set the callee keeps a new metric for `precondition`.
using Objective = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient, bool refresh_metric)>;
/// q ← M⁻¹ q with the metric of the last refresh.
using Precondition = std::function<void(Eigen::VectorXd& q)>;

/// Changes x to a point of lower loss. Unknowns never go below `lower` (−∞ where there is no bound).
MinimiserResult minimise(Eigen::VectorXd& x, const Eigen::VectorXd& lower, const Objective& objective, const Precondition& precondition,
                         const MinimiserSettings& settings);

}  // namespace pelletlab::shapegen::detail
