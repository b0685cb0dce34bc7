// A mesh cut along its sharp edges into smooth patches.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::shapegen::detail {

struct SharpEdge {
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    Vec3 inward = Vec3::Zero();  ///< bisector of the two faces, into the body, unit
    double inner_angle = 0.0;    ///< [rad], inside the body: below π for a convex edge
};

struct SmoothPatches {
    std::vector<std::uint32_t> patch_of_face;
    std::size_t count = 0;
    std::vector<SharpEdge> edges;
};

/// Triangles belong to one patch when a chain of edges bent by at most `angle` joins them.
SmoothPatches smooth_patches(const TriangleMesh& mesh, double angle);

}  // namespace pelletlab::shapegen::detail
