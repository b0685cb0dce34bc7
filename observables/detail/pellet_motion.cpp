#include "observables/detail/pellet_motion.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::observables::detail {

MotionSums PelletMotion::whole() const {
    MotionSums sum{{}, std::vector<double>(grid.cells(), 0.0), std::vector<double>(grid.cells(), 0.0), std::vector<Vec3>(grid.cells(), Vec3::Zero())};
    for (const MotionSums& group : groups) {
        sum.speeds.insert(sum.speeds.end(), group.speeds.begin(), group.speeds.end());
        for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
            sum.count[cell] += group.count[cell];
            sum.square[cell] += group.square[cell];
            sum.velocity[cell] += group.velocity[cell];
        }
    }
    return sum;
}

PelletMotion pellet_motion(const FrameSource& trajectory, const std::vector<std::vector<std::size_t>>& groups, double radius, double diameter,
                           const ViewFilter& filter) {
    const auto side = static_cast<std::size_t>(std::ceil(2.0 * radius / diameter));
    PelletMotion motion;
    motion.grid = ViewGrid::over(0.5 * static_cast<double>(side) * diameter, side, side);
    for (const auto& group : groups) {
        MotionSums sums{{},
                        std::vector<double>(motion.grid.cells(), 0.0),
                        std::vector<double>(motion.grid.cells(), 0.0),
                        std::vector<Vec3>(motion.grid.cells(), Vec3::Zero())};
        for (const std::size_t index : group) {
            const Frame frame = trajectory.frame(index);
            for (std::size_t body = 0; body < frame.positions.size(); ++body) {
                const Vec3 &p = frame.positions[body], &v = frame.velocities[body];
                if (!frame.is_tracked(body) || p.y() < filter.y_begin || p.y() >= filter.y_end) continue;
                sums.speeds.push_back(v.norm());
                std::size_t cell = 0;
                if (!motion.grid.locate(p.x(), p.z(), cell)) continue;
                sums.count[cell] += 1.0;
                sums.square[cell] += v.squaredNorm();
                sums.velocity[cell] += v;
            }
        }
        motion.groups.push_back(std::move(sums));
    }
    return motion;
}

double granular_temperature(const MotionSums& sums, const std::vector<bool>& wanted) {
    double squares = 0.0, freedoms = 0.0;
    for (std::size_t cell = 0; cell < sums.count.size(); ++cell) {
        if (!wanted[cell] || sums.count[cell] < 2.0) continue;
        squares += std::max(0.0, sums.square[cell] - sums.velocity[cell].squaredNorm() / sums.count[cell]);
        freedoms += 3.0 * (sums.count[cell] - 1.0);
    }
    return freedoms > 0.0 ? squares / freedoms : not_known;
}

std::vector<double> temperature_of_cells(const MotionSums& sums) {
    std::vector<double> temperature(sums.count.size(), not_known);
    for (std::size_t cell = 0; cell < temperature.size(); ++cell) {
        const double n = sums.count[cell];
        if (n >= 5.0) temperature[cell] = std::max(0.0, sums.square[cell] - sums.velocity[cell].squaredNorm() / n) / (3.0 * (n - 1.0));
    }
    return temperature;
}

std::vector<double> density(const std::vector<double>& values, double width, std::size_t bins) {
    std::vector<double> share(bins, 0.0);
    if (values.empty()) return std::vector<double>(bins, not_known);
    for (const double value : values) share[static_cast<std::size_t>(std::min(std::floor(value / width), static_cast<double>(bins - 1)))] += 1.0;
    for (double& one : share) one /= static_cast<double>(values.size()) * width;
    return share;
}

}  // namespace pelletlab::observables::detail
