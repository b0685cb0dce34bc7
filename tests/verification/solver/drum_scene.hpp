// Round walls cut into facets, for the tests that hold them against the exact cylinder. The polygon that stands for a circle of radius R has its area: corners
// at R sqrt(θ / sin θ) with θ = 2π/N. A bed in it has the volume that it has in the cylinder; that is what a fair comparison needs.
#pragma once

#include <string>

#include "scene.hpp"

namespace pelletlab::solver::scene {

inline double corner_radius(double radius, int facets) {
    const double angle = 2.0 * M_PI / facets;
    return radius * std::sqrt(angle / std::sin(angle));
}

/// 0 facets: the exact cylinder. Axis y; the polygon is turned by `phase` [rad] from where a corner lies on +x.
inline WallDefinition drum_shell(double radius, double length, int facets, PairParameters contact, double speed, double phase = 0.0) {
    TriangleMesh mesh = tube(facets > 0 ? corner_radius(radius, facets) : radius, length, facets > 0 ? facets : 360);
    const Quat turn(Eigen::AngleAxisd(-phase, Vec3::UnitY()));  // tube() counts its corners from x to z, which is a turn about −y
    for (Vec3& v : mesh.vertices) v = turn * v;
    WallDefinition drum = wall("drum", std::move(mesh), contact, {2e6, 0.25});
    if (facets == 0) drum.exact = exact_cylinder(Vec3::Zero(), Vec3::UnitY(), radius, -0.5 * length, 0.5 * length);
    drum.motion.rotation_speed = speed;
    return drum;
}

inline std::string drum_title(const std::string& what, int facets) {
    return what + (facets > 0 ? ", " + std::to_string(facets) + " facets" : ", exact cylinder");
}

}  // namespace pelletlab::solver::scene
