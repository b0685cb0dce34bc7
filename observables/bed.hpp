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
    bool overlaps = true;       ///< also how far true surfaces reach into each other and the wall (the costliest part)
};

/// Bed height five ways (grid-averaged top surface, 95th percentile, highest pellet, from the centre of mass, under a plate), packing fraction by them, core
/// packing fraction, axial and radial packing profiles and a map of both, cut exactly; the wall layer; orientation against the radius; neighbours and overlaps
/// of the true surfaces. All of the last frame: one instant, so standard errors are NaN except where they come from the scatter of pellets. Pellets whose
/// centre lies outside the tube are not counted. Where they leave more than a tenth of the floor bare, height and packing fraction of the grid are NaN and the
/// status is «thin bed». Throws Error(bad_input) for no frame, no pellet inside, or a geometry that is not positive.
Observables measure_tube_bed(const FrameSource& trajectory, const TubeGeometry& tube);

}  // namespace pelletlab::observables
