// The outer surface of a union of spheres as one closed triangle mesh.
#pragma once

#include <span>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::shapegen::formats {

struct UnionSurface {
    TriangleMesh mesh;             ///< [m]; every edge has exactly two triangles, normals point outward
    double voxel = 0.0;            ///< [m], edge of the sampling cells that were used
    double volume = 0.0;           ///< [m³], inside the mesh
    double vertex_distance = 0.0;  ///< [m], largest distance of a vertex from the surface of the union
    double centre_distance = 0.0;  ///< [m], largest distance of a triangle's centre from it: the chord error, largest where spheres meet in a groove
};

/// Signed distance to the union, min over the spheres of |p − c| − r: exact outside, and in sign everywhere.
double union_distance(std::span<const Sphere> spheres, const Vec3& p);

/// Samples the distance on a grid of that spacing [m] (0: 1/128 of the longest edge of the bounding box, at most a third of the smallest radius, but no finer
/// than 1/400 of that edge), meshes its zero by dual contouring (OpenVDB volumeToMesh) and moves every vertex onto the union. The same mesh for any number
/// of threads. A cavity enclosed by the spheres gets its own inward surface. Throws Error(bad_input) for a spacing that is too fine (more than 6e8 cells),
/// too coarse (more than half of the smallest radius) or not positive, and Error(numerical) if no closed mesh comes out.
UnionSurface union_surface(std::span<const Sphere> spheres, double voxel = 0.0);

}  // namespace pelletlab::shapegen::formats
