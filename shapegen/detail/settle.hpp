// Minimise a GapLoss with its own Gauss–Newton metric.
#pragma once

#include <limits>

#include "shapegen/detail/gap_loss.hpp"
#include "shapegen/detail/lbfgs.hpp"

namespace pelletlab::shapegen::detail {

struct SettleSettings {
    std::uint32_t iterations = 100;
    double tolerance = 1e-4;
    double min_radius = 0.0;
    double longest_step = 0.05;
    double give_up_above = std::numeric_limits<double>::infinity();  ///< ends early when the loss will hardly fall below this
};

/// Moves the free spheres of `loss` to a point of lower loss; they are found in loss.copy_spheres() afterwards.
MinimiserResult settle(GapLoss& loss, const SettleSettings& settings);

/// Lower bounds of `count` spheres: none for centres, the radius at least `min_radius` and never below a thousandth of the body's size.
VectorXd lower_bounds(std::size_t count, double min_radius);

}  // namespace pelletlab::shapegen::detail
