// The inside of a bed in a tube: where the pellets' volume is, how they lie, how far they stick into each other and into the wall.
#pragma once

#include <vector>

#include "core/observables.hpp"
#include "observables/bed.hpp"
#include "observables/detail/pellet_points.hpp"

namespace pelletlab::observables::detail {

/// One instant of the bed. Heights count from the floor.
struct BedInstant {
    const TrajectoryHeader& header;
    const Frame& frame;  ///< moved so that the floor is z = 0
    const TubeGeometry& tube;
    const std::vector<PelletPoints>& shapes;
    const std::vector<std::size_t>& bodies;  ///< those inside the tube
    double diameter = 0.0;                   ///< [m], mean equivalent diameter
    double h95 = 0.0, h_grid = 0.0;          ///< [m]; h_grid is NaN in a thin bed
};

/// Packing fractions, profiles and map by exact clipping; false when a shape cannot be clipped (a clump without a surface): then nothing was added.
bool add_clipped_packing(Observables& result, const BedInstant& bed);
/// Alignment of the pellets' axes with the vertical and with the radius against the distance from the axis, and next to the wall.
void add_orientation(Observables& result, const BedInstant& bed);
/// How far true surfaces reach beyond shell and floor, and into each other. Left out for shapes without a surface that are more than one sphere.
void add_overlaps(Observables& result, const BedInstant& bed);

}  // namespace pelletlab::observables::detail
