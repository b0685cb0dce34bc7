// Pairs of triangles that meet elsewhere than in a vertex or an edge that they share.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// All crossing pairs (lower face first, sorted), decided by exact predicates. Degenerate triangles and pairs on the same three vertices are left out. Works on
/// any list of triangles, closed or not: the rules are those of CGAL's self_intersections, which needs a manifold.
std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(const TriangleMesh& mesh);

}  // namespace pelletlab::meshes::detail
