// Volume, centre and inertia of a union of overlapping spheres, overlaps counted once.
#pragma once

#include <span>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen {

/// Relative accuracy 1e-6 on closed forms (two and three spheres); the method is stated in the source.
MassProperties union_mass_properties(std::span<const Sphere> spheres, double density);
double union_volume(std::span<const Sphere> spheres);

/// Plain sum over the spheres: overlaps count as often as they occur. What programs compute that know nothing of overlaps; for comparison only.
MassProperties sum_mass_properties(std::span<const Sphere> spheres, double density);

}  // namespace pelletlab::shapegen
