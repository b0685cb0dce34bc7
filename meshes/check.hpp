// Is a mesh the closed, outward-oriented surface of one body? What was found, and what was repaired.
#pragma once

#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

struct MeshReport {
    std::size_t vertices = 0, faces = 0;
    std::size_t shells = 0;              ///< connected components
    std::size_t boundary_edges = 0;      ///< edges with one triangle
    std::size_t non_manifold_edges = 0;  ///< edges with three or more
    std::size_t degenerate_faces = 0;    ///< triangles without area
    std::size_t duplicate_faces = 0;
    std::size_t inconsistent_edges = 0;  ///< neighbours that disagree about inside and outside
    std::size_t self_intersections = 0;  ///< pairs of triangles that cross
    bool inside_out = false;             ///< signed volume < 0
    double volume = 0.0;                 ///< [m³], signed as read
    double area = 0.0;                   ///< [m²]
    Vec3 extent = Vec3::Zero();          ///< [m], edges of the bounding box
    std::vector<std::string> repairs;    ///< what repair() did, in words
    bool is_closed_body() const;         ///< closed, consistently oriented outward, free of self-intersections, positive volume
    std::string summary() const;         ///< several lines for a person
};

MeshReport check(const TriangleMesh& mesh);

struct CheckedMesh {
    TriangleMesh mesh;
    MeshReport before;  ///< of the mesh as read
    MeshReport report;  ///< of the mesh returned, with .repairs
};

/// Repairs what has one right answer (inside-out, mixed orientation, degenerate and duplicate triangles) and says so in the report; throws
/// Error(bad_input) that names the defect and its place for what has none: open surface, self-intersection, zero volume, body
/// larger than 1 m or smaller than 1 µm (a forgotten unit).
CheckedMesh require_closed_body(const TriangleMesh& mesh);

}  // namespace pelletlab::meshes
