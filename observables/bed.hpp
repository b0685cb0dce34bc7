// Measurement operators of a bed in a vertical tube. Trajectory in, numbers with units and standard errors out; formulas in docs/observables.md.
#pragma once

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

struct TubeGeometry {
    double radius = 0.0;        ///< [m], inner
    double floor = 0.0;         ///< [m]
    double height_grid = 1e-3;  ///< [m], cell of the top-surface grid
    double edge_margin = 0.0;   ///< [m], ring along the wall that the top-surface grid leaves out; 0: half the pellet's equivalent diameter
};

/// Bed height five ways (grid-averaged top surface, 95th percentile, highest pellet, from the centre of mass, under a plate), packing fraction by each of them, core packing
/// fraction, mean |axis·z|, mean centroid height, axial and radial packing profiles, all of the last frame: one instant, so standard errors are NaN.
/// Pellets whose centre lies outside the tube are not counted. Where they leave more than a tenth of the floor bare, height and packing fraction of the grid are
/// NaN and the status is «thin bed». Throws Error(bad_input) for no frame, no pellet inside, or a geometry that is not positive.
Observables measure_tube_bed(const FrameSource& trajectory, const TubeGeometry& tube);

}  // namespace pelletlab::observables
