// Distances of a block of grid points, as OpenVDB's mesh-to-volume conversion finds them.
#pragma once

#include <array>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Points origin + voxel · (i, j, k), 0 ≤ i < count[0], …
struct Block {
    Vec3 origin = Vec3::Zero();  ///< [m]
    double voxel = 0.0;          ///< [m]
    std::array<std::size_t, 3> count{};
};

/// Signed distances [m], first index fastest, within `band_voxels` on both sides of the surface; beyond it ± the width of the band. OpenVDB is exact to float
/// rounding next to the surface; farther away it passes the nearest triangle on from voxel to voxel and may miss a nearer one.
std::vector<float> openvdb_distances(const TriangleMesh& mesh, const Block& block, double band_voxels);

}  // namespace pelletlab::meshes::detail
