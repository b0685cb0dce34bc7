// Prescribed rigid motion of a wall: steady translation and rotation, oscillation, a table, and their sum. Place and velocity come from the same
// formula, so the velocity at a contact point is that of the surface: v + ω × r.
#pragma once

#include <string>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab::solver {

/// One row of a table of motion, relative to the place at which the motion began.
struct MotionRow {
    double time = 0.0;          ///< [s] since the motion began
    Vec3 shift = Vec3::Zero();  ///< [m]
    double angle = 0.0;         ///< [rad] about the axis
};

/// Rigid motion of a wall, starting when the simulation is told to (Simulation::set_wall_motion). At time t since then the wall is turned about the axis
/// through `point` by  ω t + swing (sin(2π f t + φ) − sin φ) + table angle  and then shifted by  v t + oscillation (sin(2π f t + φ) − sin φ) + table shift.
/// Between rows the table follows a monotone cubic (Fritsch & Carlson 1980), so its velocity is continuous; behind the last row the wall stays there.
struct WallMotion {
    Vec3 point = Vec3::Zero();        ///< [m], on the axis
    Vec3 axis = {0.0, 1.0, 0.0};      ///< unit
    double rotation_speed = 0.0;      ///< ω [rad/s], right-handed about the axis
    Vec3 velocity = Vec3::Zero();     ///< v [m/s]
    Vec3 oscillation = Vec3::Zero();  ///< [m], amplitude of the translation
    double swing = 0.0;               ///< [rad], amplitude of the rotation
    double frequency = 0.0;           ///< f [Hz]
    double phase = 0.0;               ///< φ [rad]
    std::vector<MotionRow> table;     ///< times rise from 0, where nothing is shifted or turned; empty: none
};

struct WallPlace {
    Vec3 shift = Vec3::Zero();     ///< [m]
    Vec3 velocity = Vec3::Zero();  ///< [m/s], of the shift
    double angle = 0.0;            ///< [rad]
    double angular_speed = 0.0;    ///< [rad/s]
};

WallPlace place_at(const WallMotion& motion, double time);

/// Throws Error(bad_input) for numbers that are not finite, an axis that is not of length 1, or a table that does not begin at rest at time 0 or goes back in
/// time.
void check_motion(const WallMotion& motion, const std::string& wall);

}  // namespace pelletlab::solver
