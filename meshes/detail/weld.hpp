// Vertices that lie on the same point become one vertex: STL stores every triangle with its own three corners.
#pragma once

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Joins vertices whose coordinates are equal (bitwise, −0 = +0), keeping the first of them, and drops vertices that no face uses.
/// The order of faces and the order of first use of vertices stay. Faces that lose a corner that way are kept: check() counts them.
TriangleMesh weld(const TriangleMesh& mesh);

}  // namespace pelletlab::meshes::detail
