// Measurement operators of a rotating drum, seen along the axis. Frame: axis y, centre in the origin, z up, x to the right of a camera that looks along +y.
// Every definition stands with its formula in docs/observables.md.
#pragma once

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

struct DrumGeometry {
    double radius = 0.0;          ///< [m], inner
    double length = 0.0;          ///< [m]
    double rotation_speed = 0.0;  ///< [rad/s], positive about +y
    double velocity_grid = 2e-3;  ///< [m]
};

/// Upper and lower dynamic angle of repose (fit of the free surface's upper and lower half, see docs/observables.md), bed height, free-surface profile,
/// velocity map and its speed, all averaged over the frames in the window, standard errors from blocks of time; `status` says when the window is not steady.
/// Angles are positive when the surface rises towards the side that the drum lifts. Throws Error(bad_input) for a geometry that is not positive, a window
/// without frames, or a trajectory without pellets.
Observables measure_drum(const FrameSource& trajectory, const DrumGeometry& drum, const TimeWindow& window);

}  // namespace pelletlab::observables
