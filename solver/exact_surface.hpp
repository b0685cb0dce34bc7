// Walls in closed form: plane, cylinder, cone, disc, box. Contacts go the same way as those with meshes; only the closest point is a formula instead of a
// search, so they referee mesh walls.
#pragma once

#include "core/vec.hpp"

namespace pelletlab::solver {

/// A surface in the wall's frame. Both sides act.
struct ExactSurface {
    enum class Kind {
        none,
        plane,     ///< through `point`, normal `axis`
        revolved,  ///< the segment (radius, height) = start … end turned about `axis` through `point`: cylinder, cone, disc
        box,       ///< faces of the box about `point` with half edges `half_size` along the frame's axes
    };
    Kind kind = Kind::none;
    Vec3 point = Vec3::Zero();                                                       ///< [m]
    Vec3 axis = Vec3::UnitZ();                                                       ///< unit
    Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();  ///< [m]
    Vec3 half_size = Vec3::Zero();                                                   ///< [m]
};

ExactSurface exact_plane(const Vec3& point, const Vec3& normal);
/// Between heights low and high over `point` along the axis.
ExactSurface exact_cylinder(const Vec3& point, const Vec3& axis, double radius, double low, double high);
ExactSurface exact_cone(const Vec3& point, const Vec3& axis, double low_radius, double low, double high_radius, double high);
ExactSurface exact_disc(const Vec3& point, const Vec3& axis, double radius);
ExactSurface exact_box(const Vec3& low, const Vec3& high);

}  // namespace pelletlab::solver
