// Exact volume, centre of mass and inertia of the body inside a closed triangle mesh.
#pragma once

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// Sum over signed tetrahedra (origin, a, b, c): V = Σ det/6 and the second moments in closed form (exact for the polyhedron; Tonon 2004,
/// J. Math. Stat. 1:8–11; key tonon2004). Principal moments are sorted ascending except that an axisymmetric body keeps its axis as z; the
/// axes form a right-handed frame chosen deterministically. Density [kg/m³]. Throws Error(bad_input) when the volume is not positive.
MassProperties mass_properties(const TriangleMesh& mesh, double density);

/// Moments closer than this (relative to the largest) count as equal, and axes closer than this [rad] to a mesh axis are set to it.
inline constexpr double equal_moment_tolerance = 1e-6;

/// Principal frame of a symmetric inertia tensor: rotation (axes → frame of the tensor) and moments along the axes.
///  - three equal moments (sphere, cube): the axes of the tensor's own frame;
///  - two equal moments (axisymmetric body): z is the axis of symmetry, with its largest component positive; x is the frame's axis least aligned
///    with z, made perpendicular to it;
///  - otherwise moments ascend along x, y, z; x and y have their largest component positive, z = x × y.
struct PrincipalFrame {
    Quat axes = Quat::Identity();
    Vec3 moments = Vec3::Zero();
};
PrincipalFrame principal_frame(const Mat3& inertia);

/// Volume [m³], centroid [m] and ∫ (x − centroid)(x − centroid)ᵀ dV [m⁵] of the body inside; signed, negative for an inside-out mesh.
struct VolumeMoments {
    double volume = 0.0;
    Vec3 centroid = Vec3::Zero();
    Mat3 second = Mat3::Zero();
};
VolumeMoments volume_moments(const TriangleMesh& mesh);

}  // namespace pelletlab::meshes
