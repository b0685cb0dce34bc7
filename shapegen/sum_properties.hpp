// Mass properties of a heap of spheres, overlaps counted as often as they occur: what a DEM program gets that adds up the members of a clump. For comparison
// only; a clump carries those of the mesh or of the union.
#pragma once

#include <span>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen {

/// Σ m_i and Σ (2/5 m_i r_i² 1 + m_i (|d_i|² 1 − d_i d_iᵀ)) about the common centre, m_i = ρ 4/3 π r_i³. Principal frame as in meshes::principal_frame.
/// Throws Error(bad_input) without spheres or for a density that is not positive.
MassProperties sum_mass_properties(std::span<const Sphere> spheres, double density);

}  // namespace pelletlab::shapegen
