// Loose clouds of pellets to start from: random orientations, no overlaps.
#pragma once

#include <cstdint>
#include <vector>

#include "core/case.hpp"
#include "core/rigid_template.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::packing {

/// An upright cylinder (axis z) or a lying one (axis y) that the pellets' bounding spheres must stay inside.
struct InsertionRegion {
    enum class Axis { z, y } axis = Axis::z;
    double radius = 0.0;              ///< [m]
    double lower = 0.0, upper = 0.0;  ///< [m], along the axis
};

/// `count` pellets with random orientation at random places of the region, bounding spheres apart (random sequential addition on a jittered lattice).
/// Depends on the seed alone. Error(bad_input) «more pellets than fit» when the region cannot take them, with the number that can.
std::vector<solver::BodyPlacement> loose_cloud(const RigidTemplate& pellet, std::uint32_t count, const InsertionRegion& region, std::uint64_t seed,
                                               const Vec3& velocity);

}  // namespace pelletlab::packing
