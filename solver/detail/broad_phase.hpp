// Broad phase on bodies: pairs whose bounding spheres come closer than a skin, found with a uniform grid, sorted by (i, j).
#pragma once

#include <cstdint>
#include <vector>

#include "solver/detail/bodies.hpp"

namespace pelletlab::solver::detail {

/// Compressed rows: partners of body i are partner[first[i]] … partner[first[i + 1] − 1]: those with larger ids, ascending by id.
struct NeighbourRows {
    std::vector<std::uint32_t> first{0};
    std::vector<std::uint32_t> partner;
};

/// Scratch of the search, kept so that a search takes no new memory.
struct NeighbourScratch {
    std::vector<std::uint32_t> cell_of_body, first, next, member;
    std::vector<std::vector<std::uint32_t>> found;  ///< per piece of work
};

/// Pairs with |x_i − x_j| < R_i + R_j + skin. Bounding spheres are centred in the centres of mass, so rotation plays no role here.
void find_neighbours(const Bodies& bodies, const std::vector<BodyTemplate>& templates, double skin, NeighbourRows& rows, NeighbourScratch& scratch);

}  // namespace pelletlab::solver::detail
