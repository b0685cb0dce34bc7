// Exact volume, centre of mass and inertia of the body inside a closed triangle mesh.
#pragma once

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// Sum over signed tetrahedra (origin, a, b, c): V = Σ det/6 and the second moments in closed form (exact for the polyhedron; Tonon 2004,
/// J. Math. Stat. 1:8–11; key tonon2004). Principal moments are sorted ascending except that an axisymmetric body keeps its axis as z; the
/// axes form a right-handed frame chosen deterministically. Density [kg/m³]. Throws Error(bad_input) when the volume is not positive.
MassProperties mass_properties(const TriangleMesh& mesh, double density);

}  // namespace pelletlab::meshes
