// Signed distance to the surface of a closed mesh: negative inside, positive outside [m].
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// One way of computing the distance: the exact mesh query, or the OpenVDB grid.
class SignedDistance {
public:
    virtual ~SignedDistance() = default;
    virtual double value(const Vec3& p) const = 0;   ///< φ(p) [m]
    virtual Vec3 gradient(const Vec3& p) const = 0;  ///< ∇φ(p), unit length where φ is smooth
    virtual double error_bound() const = 0;          ///< [m], |value − true distance to the mesh| ≤ this
    /// φ at all points, in parallel.
    std::vector<double> values(std::span<const Vec3> points) const;
};

/// Exact distance to the triangles with the sign from the angle-weighted pseudonormal (Bærentzen & Aanæs 2005; key baerentzen2005): CGAL AABB tree.
/// Needs a closed, consistently oriented mesh.
std::unique_ptr<SignedDistance> exact_signed_distance(const TriangleMesh& mesh);

/// OpenVDB narrow-band level set, filled to the whole interior, of the given voxel size; trilinear between voxels. Fast, for searching.
/// Its error bound is measured against the exact query when it is built.
std::unique_ptr<SignedDistance> grid_signed_distance(const TriangleMesh& mesh, double voxel_size);

}  // namespace pelletlab::meshes
