// A wall as contact needs it: welded vertices, edges with their faces, smooth patches, and which hits count.
//
// A sphere touches a wall where the distance from its centre to the wall has a local minimum. A hit inside a face always is one; a hit on an
// edge or a vertex is one only if no face or edge that meets there leads closer to the centre. That drops the false hits at joins: convex edges act
// within their Voronoi region only, concave and flat ones never twice. Faces whose joins bend by less than the feature angle form one smooth
// patch; the minima of one patch whose directions lie within the feature angle of each other are one contact: as deep as the deepest of them, its direction
// turned towards the others so that the force is continuous. (Every minimum pushing by itself is what makes finely cut drums too stiff in other codes; the
// deepest alone would turn the force by the bend of the join at once.)
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"
#include "solver/wall_report.hpp"

namespace pelletlab::solver::detail {

struct WallMesh {
    struct Edge {
        std::array<std::uint32_t, 2> vertex{};
        std::uint32_t first_side = 0, side_count = 0;  ///< in `sides`
        bool border() const { return side_count != 2; }
    };
    std::vector<Vec3> vertices;                               ///< [m], frame of the wall
    std::vector<Triangle> faces;                              ///< degenerate and double ones are gone
    std::vector<Vec3> normals;                                ///< unit, of faces
    std::vector<std::uint32_t> patch;                         ///< of faces
    std::vector<std::array<std::uint32_t, 3>> edges_of_face;  ///< edge k joins corners k and k + 1
    std::vector<Edge> edges;
    std::vector<Vec3> sides;                  ///< unit vectors from an edge into each of its faces
    std::vector<std::uint32_t> spokes_first;  ///< per vertex, in `spokes`
    std::vector<Vec3> spokes;                 ///< unit vectors from a vertex along its edges
    std::vector<std::uint8_t> border_vertex;
    /// For the quick test whether the foot of a point lies inside a face: corner a, unit normal, and two vectors with u = along_b · (p − a),
    /// v = along_c · (p − a) the coordinates of the foot along the edges a–b and a–c.
    struct alignas(32) FacePlane {
        Vec3 a, normal, along_b, along_c;
    };
    std::vector<FacePlane> planes;
    std::uint32_t patch_count = 0;
    double cos_feature_angle = 0.0;
    double size = 0.0;  ///< [m], diagonal of the bounding box
    WallReport report;

    const Vec3& corner(std::uint32_t face, int k) const { return vertices[faces[face][static_cast<std::size_t>(k)]]; }
};

/// Welds vertices closer than 1e-9 of the box diagonal, drops faces without area and double faces, finds edges and patches.
/// Throws Error(bad_input) when nothing is left or a number is not finite; `name` is for messages.
WallMesh make_wall_mesh(const TriangleMesh& mesh, double feature_angle, const std::string& name);

enum class FeatureKind : std::uint8_t { face, edge, vertex };

/// Closest point of one face.
struct Hit {
    Vec3 point = Vec3::Zero();  ///< [m], frame of the wall
    double distance2 = 0.0;     ///< [m²]
    std::uint32_t face = 0;
    FeatureKind kind = FeatureKind::face;
    std::uint8_t corner = 0;  ///< edge k or vertex k of the face
};

/// Exact closest point on a triangle in double precision (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
Hit closest_point(const WallMesh& mesh, std::uint32_t face, const Vec3& centre);

/// Squared distance bound and hit in one: false when the sphere does not touch the face.
bool touches(const WallMesh& mesh, std::uint32_t face, const Vec3& centre, double radius, Hit& hit);

/// True when no face or edge that meets at the hit leads closer to the centre.
bool is_local_minimum(const WallMesh& mesh, const Hit& hit, const Vec3& centre);

/// Of the hits of one sphere (all faces that it touches), keeps those that are contacts: local minima, deepest first, merged within patches. The point of a
/// merged contact is where its direction leads at its distance. Works in place.
void keep_contacts(const WallMesh& mesh, const Vec3& centre, double radius, std::vector<Hit>& hits);

}  // namespace pelletlab::solver::detail
