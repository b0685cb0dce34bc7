// The modes that promise something: nothing pokes out (inside), nothing is missing (outside). Both promises are proved at the end, not sampled.
#pragma once

#include "shapegen/detail/modes.hpp"

namespace pelletlab::shapegen::detail {

/// Every sphere lies in the body but for context.poke_out: r + φ_B(c) + error bound ≤ poke_out by the exact distance. The union is as large as it gets.
MinimiserResult fit_inside(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points);

/// The union covers the body, and is as small as it gets. Proof: every triangle of the mesh is cut until each piece lies in one sphere (a ball is convex, so
/// three corners are enough), and no crease of the union lies in the body, so that no hole is left inside either.
MinimiserResult fit_outside(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points);

/// Largest r + φ_B(c), which no point of the union exceeds outside the body.
double largest_poke_out(const std::vector<Sphere>& spheres, const meshes::SignedDistance& exact);

/// How much all radii have to grow until the union covers the surface of the mesh, and has no hole inside: an upper bound, at most `finest` too large; ≤ 0: it
/// covers it already.
double missing_radius(const std::vector<Sphere>& spheres, const TriangleMesh& mesh, const meshes::SignedDistance& exact, double finest);

}  // namespace pelletlab::shapegen::detail
