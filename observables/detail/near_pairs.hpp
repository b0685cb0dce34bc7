// Pairs of bodies that may touch.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/trajectory.hpp"

namespace pelletlab::observables::detail {

/// Pairs of these bodies whose bounding spheres (`reach` [m], one a shape, about the centres of mass) come closer than `gap` [m]; each once, the smaller index
/// first, in a fixed order.
std::vector<std::pair<std::size_t, std::size_t>> near_pairs(const TrajectoryHeader& header, const Frame& frame, std::span<const std::size_t> bodies,
                                                            const std::vector<double>& reach, double gap);

}  // namespace pelletlab::observables::detail
