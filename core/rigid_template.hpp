// What the solver needs to know of a pellet: its spheres and its mass properties, in the body frame.
// The body frame has its origin in the centre of mass and its axes along the principal axes of inertia.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab {

/// A member of a clump.
struct Sphere {
    Vec3 centre = Vec3::Zero();  ///< [m]
    double radius = 0.0;         ///< [m]
};

struct MassProperties {
    double volume = 0.0;                      ///< [m³]
    double density = 0.0;                     ///< [kg/m³], particle density
    double mass = 0.0;                        ///< [kg] = density · volume
    Vec3 centre_of_mass_mesh = Vec3::Zero();  ///< [m], in the frame of the mesh as read
    Quat principal_axes = Quat::Identity();   ///< body → mesh frame
    Vec3 principal_inertia = Vec3::Zero();    ///< [kg m²], about the centre of mass, along the body axes

    Pose body_in_mesh() const { return {centre_of_mass_mesh, principal_axes}; }
};

/// Diameter of the ball of this volume [m].
inline double equivalent_diameter(double volume) {
    return std::cbrt(6.0 * volume / std::numbers::pi);
}

/// The same body of another density: mass and inertia scale with it.
inline MassProperties with_density(MassProperties properties, double density) {
    properties.principal_inertia *= density / properties.density;
    properties.mass = properties.volume * density;
    properties.density = density;
    return properties;
}

struct RigidTemplate {
    std::string name;
    std::vector<Sphere> spheres;  ///< body frame
    MassProperties mass_properties;
    double bounding_radius = 0.0;  ///< [m], of the spheres about the centre of mass
};

inline double bounding_radius(const std::vector<Sphere>& spheres) {
    double radius = 0.0;
    for (const Sphere& sphere : spheres) radius = std::max(radius, sphere.centre.norm() + sphere.radius);
    return radius;
}

}  // namespace pelletlab
