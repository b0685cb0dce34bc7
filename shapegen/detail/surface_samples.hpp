// Points spread evenly over a triangle mesh, each standing for the same area.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::shapegen::detail {

struct SurfaceSamples {
    std::vector<Vec3> points;          ///< neighbours in the list are neighbours in space (Morton order)
    std::vector<Vec3> normals;         ///< outward, of the triangle
    std::vector<std::uint32_t> faces;  ///< triangle of the point
    double area = 0.0;                 ///< of the mesh; each point stands for area / points.size()
};

/// Stratified sampling: triangles are cut until each is smaller than half a stratum and put in Morton order; each stretch of area/count along that order
/// gives one random point.
SurfaceSamples sample_surface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed);

/// Puts points of that box into Morton order: neighbours in the list are neighbours in space.
void sort_by_place(std::vector<Vec3>& points, const Box& box);

}  // namespace pelletlab::shapegen::detail
