// Global search of the fit: take a sphere from where it is least useful, put a medial ball where it helps most, let the neighbourhoods settle, and keep
// the change if the loss fell.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.hpp"
#include "core/rigid_template.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/detail/sample_blocks.hpp"

namespace pelletlab::shapegen::detail {

struct RelocationSettings {
    std::uint32_t trials = 100;
    std::uint32_t local_iterations = 25;
    std::uint64_t seed = 1;
    double min_radius = 0.0;
    double largest_radius = 1.0;  ///< first guess of a medial ball
    double tolerance = 0.0;       ///< how far a new ball may reach out of the body
    double slack = 0.0;           ///< how far any sphere may reach out for free
};

struct RelocationResult {
    std::uint32_t trials = 0, accepted = 0, iterations = 0;
    double loss = 0.0;
};

/// Spheres are in units of the body's size. The loss never grows.
RelocationResult relocate(std::vector<Sphere>& spheres, const SampleBlocks& samples, const meshes::SignedDistance& distance,
                          const RelocationSettings& settings);

}  // namespace pelletlab::shapegen::detail
