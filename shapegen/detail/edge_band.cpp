#include "shapegen/detail/edge_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"

namespace pelletlab::shapegen::detail {

std::size_t EdgeBand::CellHash::operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t k : cell) hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15U;
    return hash ^ (hash >> 32);
}

EdgeBand::EdgeBand(std::span<const SharpEdge> edges, double width) : width_(width) {
    const auto cell_of = [&](double x) { return static_cast<std::int64_t>(std::floor(x / width_)); };
    for (const SharpEdge& edge : edges) {
        // Pieces no longer than the band is wide reach few cells.
        const int count = std::max(1, static_cast<int>(std::ceil((edge.b - edge.a).norm() / width_)));
        const Vec3 along = (edge.b - edge.a) / count;
        for (int k = 0; k < count; ++k) {
            const Vec3 a = edge.a + k * along;
            const auto number = static_cast<std::uint32_t>(pieces_.size());
            pieces_.push_back({a, along});
            Cell low, high;
            for (int axis = 0; axis < 3; ++axis) {
                const auto slot = static_cast<std::size_t>(axis);
                low[slot] = cell_of(std::min(a[axis], a[axis] + along[axis]) - width_);
                high[slot] = cell_of(std::max(a[axis], a[axis] + along[axis]) + width_);
            }
            for (std::int64_t x = low[0]; x <= high[0]; ++x)
                for (std::int64_t y = low[1]; y <= high[1]; ++y)
                    for (std::int64_t z = low[2]; z <= high[2]; ++z) near_[{x, y, z}].push_back(number);
        }
    }
}

bool EdgeBand::holds(const Vec3& p) const {
    const auto cell_of = [&](double x) { return static_cast<std::int64_t>(std::floor(x / width_)); };
    const auto found = near_.find({cell_of(p.x()), cell_of(p.y()), cell_of(p.z())});
    if (found == near_.end()) return false;
    return std::any_of(found->second.begin(), found->second.end(), [&](std::uint32_t k) {
        const Piece& piece = pieces_[k];
        const double length = piece.along.squaredNorm();
        const double t = length > 0.0 ? std::clamp((p - piece.a).dot(piece.along) / length, 0.0, 1.0) : 0.0;
        return (p - piece.a - t * piece.along).squaredNorm() < width_ * width_;
    });
}

void weigh_apart_from_edges(SampleBlocks& samples, const EdgeBand& band, double weight) {
    parallel_for(samples.size(), 512, [&](std::size_t k) { samples.weight[k] = band.holds(samples.points[k]) ? 1.0 : weight; });
    double sum = 0.0;
    for (const double w : samples.weight) sum += w;
    const double scale = static_cast<double>(samples.size()) / sum;
    for (double& w : samples.weight) w *= scale;
}

}  // namespace pelletlab::shapegen::detail
