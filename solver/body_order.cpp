#include "solver/detail/body_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "solver/detail/state.hpp"

namespace pelletlab::solver::detail {

namespace {

constexpr std::uint32_t bits = 10;  ///< per axis

/// Distance along the curve of a cell.
std::uint32_t along_curve(std::array<std::uint32_t, 3> x) {
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
        const std::uint32_t p = q - 1;
        for (std::uint32_t& c : x) {
            if (c & q) {
                x[0] ^= p;
            } else {
                const std::uint32_t t = (x[0] ^ c) & p;
                x[0] ^= t;
                c ^= t;
            }
        }
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    std::uint32_t t = 0;
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
        if (x[2] & q) t ^= q - 1;
    std::uint32_t distance = 0;
    for (std::uint32_t bit = bits; bit-- > 0;)
        for (const std::uint32_t c : x) distance = (distance << 1) | (((c ^ t) >> bit) & 1u);
    return distance;
}

}  // namespace

std::vector<std::uint32_t> hilbert_order(const Bodies& bodies, double cell) {
    const std::size_t n = bodies.size();
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    if (n == 0) return order;
    Box box;
    for (std::size_t i = 0; i < n; ++i) box.extend(bodies.position(i));
    constexpr double most_cells = (1u << bits) - 1;
    const double size = std::max(cell, box.sizes().maxCoeff() / most_cells);
    std::vector<std::uint32_t> key(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 at = (bodies.position(i) - box.min()) / size;
        std::array<std::uint32_t, 3> x{};
        for (std::size_t k = 0; k < 3; ++k) x[k] = static_cast<std::uint32_t>(std::min(at[static_cast<int>(k)], most_cells));
        key[i] = along_curve(x);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : bodies.id(a) < bodies.id(b); });
    return order;
}

}  // namespace pelletlab::solver::detail

namespace pelletlab::solver {

void Simulation::State::order_bodies() {
    double largest = 0.0;
    for (const detail::BodyTemplate& t : templates) largest = std::max(largest, t.bounding_radius);
    const std::vector<std::uint32_t> order = detail::hilbert_order(bodies, 2.0 * largest);
    bodies.reorder(order);
    const auto move = [&](auto& column) {
        auto old = std::move(column);
        column.clear();
        column.reserve(old.size());
        for (const std::uint32_t k : order) column.push_back(std::move(old[k]));
        for (std::size_t k = order.size(); k < old.size(); ++k) column.push_back(std::move(old[k]));  // the padding
    };
    move(kinematics);
    for (detail::Wall& wall : walls) {
        move(wall.watches);
        move(wall.wake);
        move(wall.loads);
        move(wall.touching);
    }
}

}  // namespace pelletlab::solver
