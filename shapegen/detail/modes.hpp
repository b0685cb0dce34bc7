// The last stages of the fit, one for each mode: all start from a good mean-square fit and change what the loss charges.
#pragma once

#include <vector>

#include "shapegen/detail/lbfgs.hpp"
#include "shapegen/detail/symmetric_loss.hpp"
#include "shapegen/detail/symmetry_map.hpp"

namespace pelletlab::shapegen::detail {

/// The body and the settings that all stages need, in the frame of the fit.
struct ModeContext {
    const TriangleMesh& mesh;
    const meshes::SignedDistance& distance;  ///< to search with
    const meshes::SignedDistance& exact;     ///< to prove with
    const BodyMoments& moments;
    double min_radius = 0.0;
    double poke_out = 0.0;             ///< how far spheres may reach out of the body in the mode inside
    const SymmetryMap* map = nullptr;  ///< spheres come in its orbits
    double second = 1.0;               ///< SymmetricTerms::second of the modes mean and flat
};

/// Minimises `loss` from the given spheres, with the symmetry of the context kept exactly.
MinimiserResult polish(std::vector<Sphere>& spheres, SymmetricLoss& loss, const ModeContext& context, std::uint32_t iterations, double tolerance);

/// After a change sphere by sphere: all images of an orbit get the place of the first one and the smallest radius. Nothing without a symmetry.
void restore_symmetry(std::vector<Sphere>& spheres, const ModeContext& context);

/// Mean square of both directions, volume and inertia held.
MinimiserResult fit_mean(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points);

/// Least largest distance: the mean of higher and higher powers. `samples` should hold the sharp edges too.
MinimiserResult fit_minimax(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points);

/// As fit_mean, with the poles of the spheres that carry a flat face on one level.
MinimiserResult fit_flat(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points);

/// Puts those poles exactly on their common level (the last touch, after volume and inertia are matched).
void level_poles(std::vector<Sphere>& spheres, const ModeContext& context);

}  // namespace pelletlab::shapegen::detail
