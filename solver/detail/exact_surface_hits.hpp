// Closest points of walls in closed form.
#pragma once

#include <string>
#include <vector>

#include "solver/detail/wall_mesh.hpp"
#include "solver/exact_surface.hpp"

namespace pelletlab::solver::detail {

inline constexpr std::uint32_t exact_patches = 6;  ///< a box inside has as many

/// Distance from a point to the surface [m].
double distance_to(const ExactSurface& surface, const Vec3& centre);

/// Contacts of a sphere: the local minima of the distance that are smaller than `radius`; Hit::face is the patch.
void exact_hits(const ExactSurface& surface, const Vec3& centre, double radius, std::vector<Hit>& hits);

/// Throws Error(bad_input) for a surface without extent, naming the wall.
void check_surface(const ExactSurface& surface, const std::string& wall);

}  // namespace pelletlab::solver::detail
