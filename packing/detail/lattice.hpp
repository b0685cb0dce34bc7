// Places for spheres in a cylinder: lattices of equal spheres, and Monte Carlo moves that take the order out of them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab::packing::detail {

/// Where the centres may be: u² + v² ≤ radius², v ≤ ceiling, 0 ≤ w ≤ length.
struct CentreRegion {
    double radius = 0.0, ceiling = 0.0, length = 0.0;  ///< [m]
    bool holds(const Vec3& centre) const {
        return centre.x() * centre.x() + centre.y() * centre.y() <= radius * radius && centre.y() <= ceiling && centre.z() >= 0.0 && centre.z() <= length;
    }
};

/// Sites at least `spacing` apart from each other: the fullest of a few hexagonal lattices (layers stacked ABAB or above each other along w, centred on a
/// site or on a hole).
std::vector<Vec3> densest_lattice(const CentreRegion& region, double spacing);

/// `count` places at least `diameter` apart, spread over the region: the widest lattice that has enough sites, a random choice of them, then `sweeps` rounds
/// of random moves that keep the distance. Fewer than `count` come back when the closest lattice has no more.
std::vector<Vec3> scattered_centres(const CentreRegion& region, double diameter, std::uint32_t count, std::uint64_t seed, int sweeps);

}  // namespace pelletlab::packing::detail
