// Is a mesh the closed, outward-oriented surface of one body? What was found, and what was repaired.
#pragma once

#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// One kind of defect: how many there are, and the first of them.
struct MeshDefect {
    std::string what;  ///< «boundary edges», «self-intersecting pairs of triangles»
    std::size_t count = 0;
    Vec3 place = Vec3::Zero();  ///< [m], frame of the mesh
};

struct MeshReport {
    std::size_t vertices = 0, faces = 0;
    std::size_t shells = 0;              ///< connected components
    std::size_t separate_bodies = 0;     ///< shells that lie inside no other one; counted for closed, consistently oriented, non-crossing shells, else = shells
    std::size_t boundary_edges = 0;      ///< edges with one triangle
    std::size_t non_manifold_edges = 0;  ///< edges with three or more
    std::size_t pinched_vertices = 0;    ///< vertices where two fans of triangles touch in a point
    std::size_t degenerate_faces = 0;    ///< triangles without area: height ≤ 1e-10 of their longest edge
    std::size_t duplicate_faces = 0;     ///< further triangles on the same three vertices
    std::size_t inconsistent_edges = 0;  ///< neighbours that disagree about inside and outside
    std::size_t self_intersections = 0;  ///< pairs of triangles that cross
    bool inside_out = false;             ///< signed volume < 0
    double volume = 0.0;                 ///< [m³], signed as read
    double area = 0.0;                   ///< [m²]
    Vec3 extent = Vec3::Zero();          ///< [m], edges of the bounding box
    std::vector<std::string> repairs;    ///< what repair() did, in words
    std::vector<MeshDefect> defects;     ///< what stands between the mesh and is_closed_body(), the gravest first
    bool is_closed_body() const;         ///< closed, consistently oriented outward, free of self-intersections, positive volume, one body
    std::string summary() const;         ///< several lines for a person
};

/// Looks at the mesh as it is. Crossings are decided by exact predicates (CGAL), so rounding hides and invents none.
/// Throws Error(bad_input) for a mesh without triangles, with an index out of range or with a coordinate that is not finite.
MeshReport check(const TriangleMesh& mesh);

struct CheckedMesh {
    TriangleMesh mesh;
    MeshReport before;  ///< of the mesh as read
    MeshReport report;  ///< of the mesh returned, with .repairs
};

/// Repairs what has one right answer (inside-out, mixed orientation, degenerate and duplicate triangles, vertices on equal points) and says so in the report;
/// throws Error(bad_input) that names the defect, its count and its place for what has none: open surface, self-intersection, zero volume, several bodies,
/// body larger than 1 m or smaller than 1 µm (a forgotten unit). Shells inside the body are its cavities and are oriented so.
CheckedMesh require_closed_body(const TriangleMesh& mesh);

}  // namespace pelletlab::meshes
