// Pellets on their way round the bed: down in the active layer, up with the drum; how long each takes.
#pragma once

#include <vector>

#include "core/trajectory.hpp"
#include "observables/detail/drum_analysis.hpp"

namespace pelletlab::observables::detail {

/// (columns of the chord grid) η at which the mean downhill velocity first changes sign below the surface, averaged over a box of one pellet diameter along
/// ξ and half of one along η; NaN where there is no surface or no change of sign.
std::vector<double> zero_velocity_line(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double diameter);

/// Time that pellets were known to spend in either part [pellet · s], and passages between them.
struct Circulation {
    double active_time = 0.0, passive_time = 0.0;
    double into_active = 0.0, into_passive = 0.0;
};

/// A pellet is active once its centre is more than d/4 above the line, passive once more than d/4 below it, and stays what it was in between, so that trembling
/// on the line is no passage. A pellet that is lost is unknown until it is seen again outside that band. One entry a group of frames.
std::vector<Circulation> circulate(const FrameSource& trajectory, const std::vector<std::vector<std::size_t>>& groups, const ChordFrame& chord,
                                   const ViewGrid& grid, const std::vector<double>& line, double diameter, const ViewFilter& filter);

}  // namespace pelletlab::observables::detail
