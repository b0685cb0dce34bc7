// Sharp edges of a mesh and flat faces: what the minimax and the flat mode of the fit look at.
#pragma once

#include <vector>

#include "core/triangle_mesh.hpp"
#include "shapegen/detail/surface_samples.hpp"

namespace pelletlab::shapegen::detail {

/// Points along edges whose two triangles meet at more than `angle` [rad], about `spacing` apart, both ends included.
std::vector<Vec3> sharp_edge_points(const TriangleMesh& mesh, double angle, double spacing);

/// Adds such points to a sampling, in Morton order among themselves; each carries the weight of one sample.
void add_edge_points(SurfaceSamples& samples, const TriangleMesh& mesh, double angle, double spacing);

/// A plane that holds a good part of the surface.
struct FlatFace {
    Vec3 normal = Vec3::UnitZ();  ///< outward
    double level = 0.0;           ///< normal · x of its points
    double area = 0.0;
};

/// Faces of coplanar triangles with at least `least_share` of the area, the largest first.
std::vector<FlatFace> flat_faces(const TriangleMesh& mesh, double least_share);

}  // namespace pelletlab::shapegen::detail
