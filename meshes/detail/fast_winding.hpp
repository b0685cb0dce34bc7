// The generalised winding number at many points: a tree whose far clusters of triangles count as one dipole with its first correction.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Barill, Dickson, Schmidt, Levin, Jacobson (2018), "Fast winding numbers for soups and clouds", ACM Trans. Graph. 37(4):43 (key barill2018), with the terms
/// of first order. A cluster counts as far at `far_ratio` times its radius; near ones are summed exactly. Off by less than 0.01, so a threshold of 1/2 decides
/// as the exact sum does wherever that is not within 0.01 of 1/2, that is everywhere but in the mouths of holes.
class FastWinding {
public:
    explicit FastWinding(const TriangleMesh& mesh);
    double operator()(const Vec3& p) const;

private:
    struct Cluster {
        Vec3 centre = Vec3::Zero();  ///< mean of the triangles' centroids, weighted by area
        double radius = 0.0;         ///< to the farthest corner
        Vec3 dipole = Vec3::Zero();  ///< Σ area · normal
        Mat3 first = Mat3::Zero();   ///< Σ area · normal (centroid − centre)ᵀ
        std::uint32_t begin = 0, end = 0;
        std::uint32_t right = 0;  ///< the left child follows its parent; 0 in a leaf
    };
    void build(std::uint32_t begin, std::uint32_t end);

    std::vector<std::array<Vec3, 3>> corners_;  ///< in tree order
    std::vector<Cluster> clusters_;
};

}  // namespace pelletlab::meshes::detail
