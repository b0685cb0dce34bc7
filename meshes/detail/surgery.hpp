// The operations behind repair_to_closed_body, each done by CGAL's polygon mesh processing.
#pragma once

#include <optional>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

struct FilledMesh {
    TriangleMesh mesh;
    std::size_t holes = 0;           ///< closed
    std::size_t holes_left = 0;      ///< that no patch was found for
    double largest_perimeter = 0.0;  ///< [m], of a hole closed
};

/// Closes the loops of boundary edges. Needs consistent orientation and no edge of three triangles.
FilledMesh fill_holes(const TriangleMesh& mesh);

/// Union of the shells, each taken as a solid; nothing when a shell is open or crosses itself, or when the union is no manifold.
std::optional<TriangleMesh> unite_shells(const TriangleMesh& mesh);

/// The wrap of all triangles.
TriangleMesh alpha_wrap(const TriangleMesh& mesh, double alpha, double offset);

}  // namespace pelletlab::meshes::detail
