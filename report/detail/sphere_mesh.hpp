// Fine meshes of spheres, for pictures that colour a clump point by point.
#pragma once

#include <span>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::report::detail {

/// Unit sphere: icosahedron, every triangle cut in four `subdivisions` times; 10·4^s + 2 vertices on the sphere, outward normals.
TriangleMesh unit_sphere(int subdivisions);

/// For each vertex of the spheres' meshes, in order: how deep it lies inside the sphere that covers it most [m]; negative on the outer surface.
std::vector<double> cover_depth(std::span<const Sphere> spheres, const TriangleMesh& surfaces);

/// Longest edge of a sphere's mesh relative to its radius, for the subdivision that sphere_surfaces() takes for so many spheres.
double relative_edge(std::size_t sphere_count);

}  // namespace pelletlab::report::detail
