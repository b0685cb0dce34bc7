// Loose clouds of pellets to start from: random orientations, no overlaps.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/case.hpp"
#include "core/rigid_template.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::packing {

/// An upright cylinder (axis z) or a lying one (axis y) that the pellets' bounding spheres must stay inside; a lying one may be filled up to `ceiling` only.
struct InsertionRegion {
    enum class Axis { z, y } axis = Axis::z;
    double radius = 0.0;                                       ///< [m]
    double lower = 0.0, upper = 0.0;                           ///< [m], along the axis
    double ceiling = std::numeric_limits<double>::infinity();  ///< [m], world z that nothing of a lying cylinder's cloud reaches above
};

/// `count` pellets with random orientation at random places of the region, bounding spheres apart: a lattice as wide as the region allows, then hard-sphere
/// Monte Carlo moves that melt it (every pellet is offered 300 of them). Depends on the seed alone; pellets are ordered from the bottom up.
/// Reaches 0.20 solid fraction with a 3.12 × 2.96 mm cylinder in a 52 mm tube (0.33 is the most that its bounding spheres allow there).
/// Error(bad_input) «more pellets than fit» when the region cannot take them, with the number that can; «pellet larger than …» when not even one fits.
std::vector<solver::BodyPlacement> loose_cloud(const RigidTemplate& pellet, std::uint32_t count, const InsertionRegion& region, std::uint64_t seed,
                                               const Vec3& velocity);

/// Upright region of that radius from z = lower up, as high as `count` pellets need at that packing fraction, and higher while the bounding spheres of the
/// pellets (long ones, or a narrow tube) have no room to be disordered.
InsertionRegion upright_region(const RigidTemplate& pellet, std::uint32_t count, double packing_fraction, double radius, double lower);

/// How many pellets loose_cloud can place in the region.
std::uint32_t cloud_capacity(const RigidTemplate& pellet, const InsertionRegion& region);

}  // namespace pelletlab::packing
