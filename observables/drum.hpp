// Measurement operators of a rotating drum, seen along the axis. Frame: axis y, centre in the origin, z up, x to the right of a camera that looks along +y.
// Every definition stands with its formula in docs/observables.md.
#pragma once

#include <limits>

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

struct DrumGeometry {
    double radius = 0.0;                                           ///< [m], inner
    double length = 0.0;                                           ///< [m]
    double rotation_speed = 0.0;                                   ///< [rad/s], positive about +y
    double velocity_grid = 2e-3;                                   ///< [m]
    double slab_begin = -std::numeric_limits<double>::infinity();  ///< [m], only this axial slab is measured: slab_begin ≤ y < slab_end
    double slab_end = std::numeric_limits<double>::infinity();
    double view_depth = 0.0;      ///< [m], how deep behind the front plate (y = −length/2) the camera sees; 0: two equivalent diameters
    double camera_grid = 0.5e-3;  ///< [m], of the camera's maps
    double pellets_each = 1.0;    ///< pellets that every body stands for, when only some of those in the drum were tracked
    bool depth_known = true;      ///< false: the trajectory holds no y (a camera's plane), so nothing is measured that needs it
};

/// Upper and lower dynamic angle of repose (fit of the free surface's upper and lower half, see docs/observables.md), bed height, free-surface profile,
/// velocity map and its speed, all averaged over the frames in the window, standard errors from blocks of time; `status` says when the window is not steady.
/// Angles are positive when the surface rises towards the side that the drum lifts. Throws Error(bad_input) for a geometry that is not positive, a window
/// without frames, or a trajectory without pellets.
Observables measure_drum(const FrameSource& trajectory, const DrumGeometry& drum, const TimeWindow& window);

}  // namespace pelletlab::observables
