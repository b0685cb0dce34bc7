// Measurement operators of a bed in a vertical tube. Trajectory in, numbers with units and standard errors out; formulas in docs/observables.md.
#pragma once

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

struct TubeGeometry {
    double radius = 0.0;        ///< [m], inner
    double floor = 0.0;         ///< [m]
    double height_grid = 1e-3;  ///< [m], cell of the top-surface grid
};

/// Bed height (grid-averaged top surface, 95th percentile, highest point, from the centre of mass), packing fraction by each of them, mean |axis·z|, all of the
/// last frame.
Observables measure_tube_bed(const FrameSource& trajectory, const TubeGeometry& tube);

}  // namespace pelletlab::observables
