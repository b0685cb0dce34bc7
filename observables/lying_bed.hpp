// The bed in a cylinder that lies at rest: how high it is filled. Trajectory in, numbers with units out; formulas in docs/observables.md.
#pragma once

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

struct LyingGeometry {
    double radius = 0.0;        ///< [m], inner; axis y, centre in the origin
    double length = 0.0;        ///< [m], from y = −length/2 to length/2
    double height_grid = 1e-3;  ///< [m], cell of the top-surface grid
};

/// Fill level two ways (mean top surface, centre of mass), the highest pellet, packing fractions to each level, share of the vessel's volume, of the last
/// frame. `status` is «thin bed» when more than a tenth of the grid lines meet no pellet. Throws Error(bad_input) for a geometry without size and for no
/// pellets.
Observables measure_lying_bed(const FrameSource& trajectory, const LyingGeometry& vessel);

/// Area of the part of a circle below z = level, and the height of its centroid [m², m]; the circle is centred in the origin.
double segment_area(double radius, double level);
double segment_centroid(double radius, double level);

}  // namespace pelletlab::observables
