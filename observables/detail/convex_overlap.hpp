// Two convex bodies that reach into each other: by how much, as a length and as a volume.
#pragma once

#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::observables::detail {

/// A convex polyhedron in the world, ready for questions: its corners, and its flat faces as polygons of them, counter-clockwise seen from outside.
struct ConvexBody {
    struct Face {
        Vec3 normal;          ///< outward, unit
        double offset = 0.0;  ///< normal · x on the face [m]
        std::vector<std::uint32_t> corners;
    };
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    Vec3 centre = Vec3::Zero();
};

/// True when no vertex lies further above any face than `slack`.
bool is_convex(const TriangleMesh& mesh, double slack);

/// Body of a convex mesh. Triangles of one plane (normals within 1.4e-5, offsets within 1e-6 of the size: the rounding of a mesh in single precision) are one
/// face, and vertices inside faces or edges are left out: a finely meshed cylinder becomes a prism of few faces.
ConvexBody convex_body(const TriangleMesh& mesh);
/// The same, moved.
ConvexBody moved(const ConvexBody& body, const Pose& pose);

/// Smallest displacement of b that parts them, min over unit vectors n of max_a a·n − min_b b·n [m]; negative: minus a gap no larger than the true one.
/// Stops early with a number below −`largest_gap` once such a gap is certain. Searched on the sphere of directions from the line of centres, in steps that are
/// halved down to 1e-4; when that finds no gap, also from the best of all face normals, where polyhedra that overlap have their minimum unless two edges
/// cross. Accuracy 1e-4 of the bodies' size.
double penetration(const ConvexBody& a, const ConvexBody& b, double largest_gap);

/// Volume that both fill [m³]: one third of Σ area · distance to a point, over the faces of each cut by all planes of the other. Exact but for the rounding
/// that convex_body smooths out; faces that both share count once.
double common_volume(const ConvexBody& a, const ConvexBody& b);

}  // namespace pelletlab::observables::detail
