// Torque-free motion of a rigid body, computed here, and the pose of a clump found from where a program says its spheres are.
#pragma once

#include <vector>

#include "core/rigid_template.hpp"

namespace pelletlab::crosscode {

struct FittedPose {
    Pose pose;
    double worst = 0.0;  ///< [m], largest distance of a sphere from where the pose puts it
};

/// Best rotation and shift of the template's centres onto `positions` (Kabsch 1976, by the SVD of the covariance).
FittedPose fit_pose(const std::vector<Sphere>& spheres, const std::vector<Vec3>& positions);

/// Orientation after `time` of a body that is at `start` with spin `spin_world` [rad/s] and feels no torque: q' = ½ ω q with constant angular momentum,
/// fourth-order Runge–Kutta with 20 000 steps (error below 1e-12 rad here).
Quat free_rotation(const Quat& start, const Vec3& spin_world, const Vec3& principal_inertia, double time);

/// Rotational energy [J].
double spin_energy(const Quat& orientation, const Vec3& spin_world, const Vec3& principal_inertia);

}  // namespace pelletlab::crosscode
