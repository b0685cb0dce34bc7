#include "observables/detail/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace pelletlab::observables::detail {

std::vector<std::pair<std::size_t, std::size_t>> near_pairs(const TrajectoryHeader& header, const Frame& frame, std::span<const std::size_t> bodies,
                                                            const std::vector<double>& reach, double gap) {
    const double cell = 2.0 * *std::max_element(reach.begin(), reach.end()) + gap;
    using Key = std::tuple<long, long, long>;
    const auto key = [cell](const Vec3& p) {
        return Key{static_cast<long>(std::floor(p.x() / cell)), static_cast<long>(std::floor(p.y() / cell)), static_cast<long>(std::floor(p.z() / cell))};
    };
    std::map<Key, std::vector<std::size_t>> cells;
    for (const std::size_t body : bodies) cells[key(frame.positions[body])].push_back(body);
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    const auto add_near_in = [&](std::size_t a, const std::vector<std::size_t>& others) {
        for (const std::size_t b : others) {
            if (b <= a) continue;
            const double limit = reach[header.shape_of_body[a]] + reach[header.shape_of_body[b]] + gap;
            if ((frame.positions[a] - frame.positions[b]).squaredNorm() < limit * limit) pairs.emplace_back(a, b);
        }
    };
    for (const std::size_t a : bodies) {
        const auto [x, y, z] = key(frame.positions[a]);
        for (long dx = -1; dx <= 1; ++dx)
            for (long dy = -1; dy <= 1; ++dy)
                for (long dz = -1; dz <= 1; ++dz)
                    if (const auto found = cells.find(Key{x + dx, y + dy, z + dz}); found != cells.end()) add_near_in(a, found->second);
    }
    return pairs;
}

}  // namespace pelletlab::observables::detail
