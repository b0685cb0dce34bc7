#include "shapegen/detail/settle.hpp"

#include <algorithm>
#include <limits>

namespace pelletlab::shapegen::detail {

VectorXd lower_bounds(std::size_t count, double min_radius) {
    VectorXd lower = VectorXd::Constant(static_cast<Eigen::Index>(4 * count), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < count; ++i) lower[static_cast<Eigen::Index>(4 * i + 3)] = std::max(min_radius, 1e-3);
    return lower;
}

MinimiserResult settle(GapLoss& loss, const SettleSettings& settings) {
    BlockMetric metric;
    const Objective objective = [&](const VectorXd& x, VectorXd& gradient, bool refresh) {
        const double value = loss.evaluate(x, &gradient, refresh ? &metric : nullptr);
        if (refresh) metric.factorise(0.05);
        return value;
    };
    MinimiserSettings minimiser;
    minimiser.iterations = settings.iterations;
    minimiser.tolerance = settings.tolerance;
    minimiser.longest_step = settings.longest_step;
    minimiser.give_up_above = settings.give_up_above;
    VectorXd x = loss.free_values();
    const MinimiserResult result = minimise(
        x, lower_bounds(loss.free_spheres().size(), settings.min_radius), objective, [&](VectorXd& q) { metric.apply(q); }, minimiser);
    loss.set_free_values(x);
    return result;
}

}  // namespace pelletlab::shapegen::detail
