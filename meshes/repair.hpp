// Repairs that are a matter of judgement: closing open surfaces, uniting shells that cross, wrapping what is beyond both. Never done unasked.
#pragma once

#include "meshes/check.hpp"

namespace pelletlab::meshes {

enum class RepairMethod {
    automatic,     ///< the gentlest of the following that gives a closed body
    fill_holes,    ///< closes every hole with a smooth patch; the rest of the surface stays as it is
    unite_shells,  ///< the union of closed shells that cross each other (exact predicates); away from the seams the surface stays as it is
    alpha_wrap     ///< shrink-wraps the outside (CGAL 3D alpha wrapping; Portaneri et al. 2022, ACM Trans. Graph. 41(4), key portaneri2022): always closed, but
                   ///< rounded in grooves narrower than alpha, without cavities, and a little outside of the given surface
};

struct RepairSettings {
    RepairMethod method = RepairMethod::automatic;
    double alpha = 0.0;   ///< [m], wrap: bridges holes and grooves narrower than this; 0: 1/30 of the bounding box's diagonal,
                          ///< more where a hole is wider, and enlarged while the wrap would slip in
    double offset = 0.0;  ///< [m], wrap: distance of the wrap from the surface before it is drawn in; 0: 1/900 of the diagonal
};

/// Makes a closed body of an open, self-intersecting or multi-shell mesh. What was done stands in report.repairs, with its extent: holes and their size, shells
/// united, how far the wrap lies from the given surface. A mesh that require_closed_body accepts comes back as that returns it.
/// After wrapping, vertices are drawn in to the given surface as far as the wrap stays free of crossings.
/// Throws Error(bad_input) for what cannot be mended: a sheet without a volume of its own, bodies too far apart for one wrap, a size outside 1 µm … 1 m,
/// a wrap with alpha ≤ 0 or so fine that it would need more than about two million triangles; and when the one method asked for does not give a closed body.
CheckedMesh repair_to_closed_body(const TriangleMesh& mesh, const RepairSettings& settings = {});

}  // namespace pelletlab::meshes
