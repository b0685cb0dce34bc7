// Measurement operators of an attrition tester: a turning drum with one baffle. Trajectory in, numbers and maps out; formulas in docs/observables.md.
#pragma once

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

inline constexpr std::size_t baffle_angles = 8;  ///< 0°, 45°, … 315°

/// Axis y, centre in the origin; seen along +y with x to the right and z up. The baffle's angle is 0 at the bottom and grows with the turn.
struct TesterGeometry {
    double radius = 0.127;         ///< [m]
    double length = 0.152;         ///< [m]
    double baffle_height = 0.051;  ///< [m]
    double rotation_speed = 0.0;   ///< [rad/s] about +y; negative: everything is mirrored
    double baffle_angle = 0.0;     ///< [rad], at `angle_time`
    double angle_time = 0.0;       ///< [s]
    double grid = 2e-3;            ///< [m], cell of the maps
};

/// Of the frames in the window (its begin not, its end counted): occupancy maps at the eight angles, averaged over turns («cloud_000» … «cloud_315»), share of
/// pellets in the cloud and place of all pellets' centre at each of them, the load of the baffle against its angle, and the release angles at which 10, 50 and
/// 90 % of the largest load have left it. Standard errors are those of the mean over turns. `status` is «too few turns» with less than two, «frames too far
/// apart» when no frame is near one of the eight angles. Throws Error(bad_input) for a geometry without size, a drum that does not turn, and a window without a
/// frame.
Observables measure_tester(const FrameSource& trajectory, const TesterGeometry& tester, const TimeWindow& window);

}  // namespace pelletlab::observables
