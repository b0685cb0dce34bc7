// Fine meshes of spheres, for pictures that colour a clump point by point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::report::detail {

/// Unit sphere: icosahedron, every triangle cut in four `subdivisions` times; 10·4^s + 2 vertices on the sphere, outward normals.
TriangleMesh unit_sphere(int subdivisions);

/// The triangles of the spheres' meshes that can show: those with no corner deeper inside another sphere than their edges are long.
struct ShowingSurface {
    TriangleMesh mesh;                  ///< [m]
    std::vector<Vec3> normals;          ///< one a vertex, of its sphere
    std::vector<std::uint32_t> sphere;  ///< one a vertex
    std::vector<std::size_t> number;    ///< one a vertex: its number in sphere_surfaces()
};
ShowingSurface showing_surface(std::span<const Sphere> spheres);

/// Longest edge of a sphere's mesh relative to its radius, for the subdivision that sphere_surfaces() takes for so many spheres.
double relative_edge(std::size_t sphere_count);

}  // namespace pelletlab::report::detail
