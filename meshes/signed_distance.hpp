// Signed distance to the surface of a closed mesh: negative inside, positive outside [m].
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// φ and ∇φ at one point.
struct DistanceSample {
    double value = 0.0;            ///< [m]
    Vec3 gradient = Vec3::Zero();  ///< unit length where φ is smooth
};

/// One way of computing the distance: the exact mesh query, or a grid. All queries are const and may run side by side.
class SignedDistance {
public:
    virtual ~SignedDistance() = default;
    virtual double value(const Vec3& p) const = 0;   ///< φ(p) [m]
    virtual Vec3 gradient(const Vec3& p) const = 0;  ///< ∇φ(p), unit length where φ is smooth
    virtual double error_bound() const = 0;          ///< [m], |value − true distance to the mesh| ≤ this
    /// Both at once, at the price of one.
    virtual DistanceSample sample(const Vec3& p) const { return {value(p), gradient(p)}; }
    /// φ at all points, in parallel.
    std::vector<double> values(std::span<const Vec3> points) const;
};

/// Exact distance to the triangles with the sign from the angle-weighted pseudonormal (Bærentzen & Aanæs 2005; key baerentzen2005): nearest triangle
/// from a tree of boxes. On the surface the gradient is the pseudonormal; where several points are nearest it belongs to one of them.
/// Needs a closed, consistently oriented mesh: throws Error(bad_input) for a mesh that require_closed_body would have to change.
std::unique_ptr<SignedDistance> exact_signed_distance(const TriangleMesh& mesh);

/// Distance to the triangles of any mesh, open, crossing itself or of several shells, with the sign from the generalised winding number: inside where the
/// surface goes round the point more than half (Jacobson et al. 2013; tree of Barill et al. 2018; key barill2018). The value is exact up to its sign, which
/// changes without passing zero across the mouth of a hole. The triangles should agree about outside: check().inconsistent_edges = 0.
/// Throws Error(bad_input) for a mesh without triangles or with triangles without area.
std::unique_ptr<SignedDistance> winding_signed_distance(const TriangleMesh& mesh);

/// Who computes the distances at the points of a grid.
enum class GridFill {
    exact_query,  ///< the exact query at each point, in the whole interior and the rim
    exact_band,   ///< the exact query at the points in a band of 4 voxels on both sides of the surface; farther away it answers itself
    openvdb       ///< OpenVDB's mesh to level set conversion, in a band of 4 voxels on both sides of the surface; farther away the exact query answers itself
};

/// Distances on a regular grid of the given voxel size, trilinear between its points, kept as one dense block of floats. Fast, for searching.
/// The grid covers the body's bounding box and a rim of max(0.25 · its smallest edge, 3 voxels) and is centred on the body. Beyond it the value is that of the
/// nearest point of the grid's box plus the way to it, an upper bound of the distance.
/// The error bound is measured against the exact query when the grid is built, at the middles of all cells (of every n-th above two million; of a band of
/// every n-th above five thousand, OpenVDB's also at corners): 1.5 × (a band: 2 ×) the largest error found, but at most √3/2 voxels, which no interpolated
/// distance exceeds when it is exact at the points. It holds inside the grid's box.
/// Throws Error(bad_input) for a voxel that is not positive, wider than a quarter of the body's smallest extent, or so small that more than 512 million are
/// needed, and for a mesh that exact_signed_distance refuses.
/// `exact`: that of the same mesh, where it is known already.
std::unique_ptr<SignedDistance> grid_signed_distance(const TriangleMesh& mesh, double voxel_size, GridFill fill = GridFill::exact_query,
                                                     std::shared_ptr<const SignedDistance> exact = nullptr);

}  // namespace pelletlab::meshes
