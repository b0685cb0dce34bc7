// Where the fit starts: medial balls chosen so that the largest gap to the surface shrinks fastest.
#pragma once

#include <vector>

#include "core/rigid_template.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/detail/sample_blocks.hpp"

namespace pelletlab::shapegen::detail {

struct SeedSettings {
    std::size_t count = 1;
    double min_radius = 0.0;
    double largest_radius = 1.0;  ///< first guess of a ball, for instance half the body's diagonal
    double tolerance = 0.0;       ///< how far a ball may reach out of the body
};

/// Farthest-point insertion in the metric of the gaps: the first ball is the largest one, each next one is the medial ball at the surface point that the
/// balls so far leave farthest away. Gaps grow like s²/2t beside a ball at distance t from an edge, so balls become dense like 1/t towards edges by themselves.
std::vector<Sphere> seed_by_gaps(const SampleBlocks& samples, const meshes::SignedDistance& distance, const SeedSettings& settings);

}  // namespace pelletlab::shapegen::detail
