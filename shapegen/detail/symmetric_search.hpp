// Seeds and relocation for a clump with symmetry: whole orbits of spheres are placed, taken away and placed elsewhere.
#pragma once

#include "shapegen/detail/relocation.hpp"
#include "shapegen/detail/seeding.hpp"
#include "shapegen/detail/symmetry_map.hpp"

namespace pelletlab::shapegen::detail {

struct SymmetricSpheres {
    std::vector<Generator> generators;

    std::vector<std::size_t> places() const;
    std::vector<Sphere> spheres() const;  ///< of the generators
};

/// As seed_by_gaps; a ball near a mirror plane, an axis or the centre is moved onto it, and the orbits add up to settings.count exactly.
/// `samples` lie in the group's domain (SymmetryGroup::in_domain).
SymmetricSpheres seed_orbits(const SymmetryGroup& group, const SampleBlocks& samples, const meshes::SignedDistance& distance, const SeedSettings& settings);

/// Minimises the loss over the generators. Returns the loss.
double settle_orbits(const SymmetryGroup& group, SymmetricSpheres& state, const SampleBlocks& samples, const Containment& containment, std::uint32_t iterations,
                     double tolerance, double min_radius, double give_up_above, std::uint32_t& iterations_done);

/// As relocate: one or two orbits go, as many spheres come back where the gaps are largest, all settle, and the change stays if the loss fell.
RelocationResult relocate_orbits(const SymmetryGroup& group, SymmetricSpheres& state, const SampleBlocks& samples, const meshes::SignedDistance& distance,
                                 const RelocationSettings& settings);

}  // namespace pelletlab::shapegen::detail
