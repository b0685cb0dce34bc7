// Small repairs that have one right answer. Each returns how much it changed.
#pragma once

#include <cstddef>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Height ≤ 1e-10 of the longest edge: far below the 6e-8 of a 32-bit file, far above the rounding of a change of unit.
bool is_degenerate(const TriangleMesh& mesh, const Triangle& triangle);

/// Keeps one of all triangles on the same three vertices.
std::size_t drop_duplicates(TriangleMesh& mesh);

/// Drops triangles with a repeated corner.
std::size_t drop_repeated_corners(TriangleMesh& mesh);

/// Removes triangles without area and keeps the surface closed: a needle's short edge is shrunk to a point, a cap's long edge is flipped. Needs consistent
/// orientation. Returns how many were removed; some may stay where the surroundings allow neither.
std::size_t remove_degenerate(TriangleMesh& mesh);

}  // namespace pelletlab::meshes::detail
