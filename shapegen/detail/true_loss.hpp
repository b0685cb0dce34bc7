// The mean square distance between body and union as the quality report means it, for judging fits within the search.
#pragma once

#include <vector>

#include "core/rigid_template.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/detail/sample_blocks.hpp"

namespace pelletlab::shapegen::detail {

/// ½ (mean φ_U² over about `points` of the samples + mean φ_B² over about as many points of the union's outer surface). φ_U is the true distance to the union's
/// surface: the minimiser's min |p − c| − r is a bound of the depth inside, far off for few spheres. It prefers four in a tetrahedron to three in a row, which
/// are better. Weights of the samples do not count.
double true_loss(const std::vector<Sphere>& spheres, const SampleBlocks& samples, const meshes::SignedDistance& distance, std::size_t points);

}  // namespace pelletlab::shapegen::detail
