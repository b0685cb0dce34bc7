// Vectors, rotations and boxes that every room shares. SI units; right-handed frames.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pelletlab {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  ///< unit quaternion; rotates body coordinates into world coordinates

/// Rigid placement of a frame: x_world = orientation * x_body + position.
struct Pose {
    Vec3 position = Vec3::Zero();         ///< [m], world
    Quat orientation = Quat::Identity();  ///< body → world

    Vec3 to_world(const Vec3& p_body) const { return orientation * p_body + position; }
    Vec3 to_body(const Vec3& p_world) const { return orientation.conjugate() * (p_world - position); }
};

using Box = Eigen::AlignedBox3d;  ///< axis-aligned box [m]; a default-constructed one is empty

}  // namespace pelletlab
