// Volume that two bodies do not share: a mesh and a union of spheres, cut into columns along z.
#pragma once

#include <span>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::shapegen::detail {

struct OverlapVolumes {
    double mesh = 0.0;     ///< [m³], by the same columns
    double spheres = 0.0;  ///< [m³]
    double missing = 0.0;  ///< [m³], in the mesh and in no sphere
    double outside = 0.0;  ///< [m³], in a sphere and not in the mesh
};

/// Exact along z, `columns`² columns across the common box. Inside the mesh is where the winding of the triangles above is positive.
OverlapVolumes column_overlap(const TriangleMesh& mesh, std::span<const Sphere> spheres, int columns);

}  // namespace pelletlab::shapegen::detail
