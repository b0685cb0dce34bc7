// The bed seen from above: the highest point of any pellet on each vertical line of a square grid.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/trajectory.hpp"

namespace pelletlab::observables::detail {

/// Heights on the lines x = i·spacing, y = j·spacing, |i|, |j| ≤ half_count; −∞ where no pellet is met.
struct HeightGrid {
    double spacing = 0.0;
    int half_count = 0;
    std::vector<double> height;

    std::size_t side() const { return static_cast<std::size_t>(2 * half_count + 1); }
    std::size_t index(int i, int j) const { return static_cast<std::size_t>(j + half_count) * side() + static_cast<std::size_t>(i + half_count); }
};

/// Top surface of these bodies over the square |x|, |y| ≤ extent: of the pellets' true surface where the shape has one, else of their spheres.
/// World z [m]; exact on every grid line.
HeightGrid top_surface(const TrajectoryHeader& header, const Frame& frame, std::span<const std::size_t> bodies, double extent, double spacing);

}  // namespace pelletlab::observables::detail
