// Largest balls inside a body that touch its surface in a given point (shrinking ball: Ma, Bae & Choi 2012; key ma2012).
#pragma once

#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen::detail {

/// Radius of the largest ball that touches the surface in p from inside (outward normal n) and reaches out of the body by at most `tolerance`.
/// Starts from `largest` and shrinks until the ball fits; the tolerance keeps the facets of a curved surface from shrinking it to nothing.
double medial_radius(const meshes::SignedDistance& distance, const Vec3& p, const Vec3& n, double largest, double tolerance);

}  // namespace pelletlab::shapegen::detail
