// Two convex bodies that reach into each other: by how much, as a length and as a volume.
#pragma once

#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::observables::detail {

/// A convex polyhedron in the world, ready for questions: vertices, triangles and the distinct planes of its faces (outward normal · x = offset).
struct ConvexBody {
    struct Plane {
        Vec3 normal;
        double offset = 0.0;
    };
    std::vector<Vec3> vertices;
    std::vector<Triangle> faces;
    std::vector<Plane> planes;
    Vec3 centre = Vec3::Zero();
};

/// True when no vertex lies further above any face than `slack`.
bool is_convex(const TriangleMesh& mesh, double slack);

/// Body of a convex mesh; triangles of one plane give one plane.
ConvexBody convex_body(const TriangleMesh& mesh);
/// The same, moved.
ConvexBody moved(const ConvexBody& body, const Pose& pose);

/// Smallest displacement of b that parts them, min over unit vectors n of max_a a·n − min_b b·n [m]; negative: minus a gap no larger than the true one.
/// Stops early with a number below −`largest_gap` once such a gap is certain. The minimum is searched on the sphere of directions from the line of centres, in
/// steps that are halved down to 1e-4: exact to 1e-4 of the bodies' size for bodies that are apart or overlap by much less than their size.
double penetration(const ConvexBody& a, const ConvexBody& b, double largest_gap);

/// Volume that both fill [m³]: one third of Σ area · distance to a point inside, over the faces of each cut by all planes of the other. Exact.
double common_volume(const ConvexBody& a, const ConvexBody& b);

}  // namespace pelletlab::observables::detail
