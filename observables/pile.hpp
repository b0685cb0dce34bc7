// Measurement operators of a pile on a flat plate. Trajectory in, numbers with units and standard errors out; formulas in docs/observables.md.
#pragma once

#include <limits>

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

struct PileGeometry {
    double plate = 0.0;                                        ///< [m], z of the plate's upper face
    double axis_x = 0.0, axis_y = 0.0;                         ///< [m], where the pellets were poured: run-out counts from here
    double ceiling = std::numeric_limits<double>::infinity();  ///< [m], pellets with their centre above it are still in the funnel and do not count
    double height_grid = 1e-3;                                 ///< [m], cell of the top-surface grid
};

/// Pile height three ways (highest point of the smoothed top surface, highest pellet, apex of the fitted cone), angle of repose from the cone and from the
/// silhouettes of four sides, run-out, radius of the base, packing fraction, mean profile, silhouettes and top surface, of the last frame. Standard errors come
/// from 16 azimuth sectors (cone, run-out, base, profile) or the four sides. `status` is «not at rest» when more than 5 % of the pellets move faster than
/// 0.01 √(g d), «no pile» when the smoothed surface is lower than two pellet diameters or has no flank: then there are no angles.
/// Throws Error(bad_input) for no frame, no pellet on the plate, or a height grid that is not positive.
Observables measure_pile(const FrameSource& trajectory, const PileGeometry& pile);

}  // namespace pelletlab::observables
