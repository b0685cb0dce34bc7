// Volume, centre and inertia of a union of overlapping spheres, overlaps counted once.
#pragma once

#include <span>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen {

/// Relative accuracy 1e-6 on closed forms (two and three spheres); the method is stated in the source.
MassProperties union_mass_properties(std::span<const Sphere> spheres, double density);
double union_volume(std::span<const Sphere> spheres);

}  // namespace pelletlab::shapegen
