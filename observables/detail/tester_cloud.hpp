// Pellets of one instant in an attrition tester: seen along the axis, alone or in company, on the baffle or off it.
#pragma once

#include <span>
#include <vector>

#include "observables/detail/end_view.hpp"
#include "observables/tester.hpp"

namespace pelletlab::observables::detail {

/// Adds the pellets' volume [m³] to the cells of the end view (x, z) into which it falls.
void add_end_view(std::vector<double>& volume, const ViewGrid& grid, const TrajectoryHeader& header, const Frame& frame,
                  const std::vector<PelletPoints>& shapes);

/// Share of the pellets with fewer than 3 other centres within 1.5 d, d the mean equivalent diameter: a pellet in a bed has 6 and more. NaN without pellets.
double loose_share(const TrajectoryHeader& header, const Frame& frame, const std::vector<PelletPoints>& shapes);

/// Volume-weighted mean of the centres [m].
Vec3 centre_of_pellets(const TrajectoryHeader& header, const Frame& frame, const std::vector<PelletPoints>& shapes);

/// Pellets that the baffle carries at that angle: centre within its height of the shell and at most its height ahead of its middle plane, slower than
/// 0.2 |ω| R against the turning drum.
std::size_t carried_by_baffle(const Frame& frame, const TesterGeometry& tester, double angle);

/// First angle behind the largest load at which the load has fallen to `share` of it, linear between bins; it may exceed 2π. NaN without a load of one pellet
/// or more, or when the load stays above.
double release_angle(std::span<const double> angle, std::span<const double> load, double share);

}  // namespace pelletlab::observables::detail
