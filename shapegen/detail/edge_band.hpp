// Where a surface is near its sharp edges.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/vec.hpp"
#include "shapegen/detail/sample_blocks.hpp"
#include "shapegen/detail/smooth_patches.hpp"

namespace pelletlab::shapegen::detail {

/// All points nearer than `width` to one of these edges. A query looks at the few pieces of edges around its point, however many edges there are.
class EdgeBand {
public:
    EdgeBand(std::span<const SharpEdge> edges, double width);
    bool holds(const Vec3& p) const;

private:
    struct Piece {
        Vec3 a, along;
    };
    using Cell = std::array<std::int64_t, 3>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const;
    };

    double width_;
    std::vector<Piece> pieces_;
    std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> near_;  // pieces that may come within the width of a point in the cell
};

/// Samples outside of the band weigh `weight` times those inside; one on average. Nothing changes where there are no edges, or nothing else.
void weigh_apart_from_edges(SampleBlocks& samples, const EdgeBand& band, double weight);

}  // namespace pelletlab::shapegen::detail
