// Bodies that are neighbours in space should be neighbours in memory: a step then reads what is already in the cache, and each thread has a region of
// its own. Bodies lie in memory along a Hilbert curve; users, checkpoints and sums see them by their ids, the order in which they were added, so no result
// depends on where a body lies.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/detail/bodies.hpp"

namespace pelletlab::solver::detail {

/// Places in memory, in the order of a Hilbert curve (Skilling, AIP Conference Proceedings 707, 381, 2004) over cells of the given size [m].
std::vector<std::uint32_t> hilbert_order(const Bodies& bodies, double cell);

}  // namespace pelletlab::solver::detail
