#include "shapegen/detail/outer_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pelletlab::shapegen::detail {

OuterSurface::OuterSurface(std::span<const Sphere> spheres, int resolution) {
    Box box;
    for (const Sphere& s : spheres) {
        box.extend(Vec3(s.centre.array() - s.radius));
        box.extend(Vec3(s.centre.array() + s.radius));
    }
    if (box.isEmpty()) return;
    step_ = box.sizes().maxCoeff() / resolution;
    origin_ = box.min() - Vec3::Constant(2.0 * step_);
    for (int k = 0; k < 3; ++k) size_[k] = static_cast<std::int64_t>(std::ceil(box.sizes()[k] / step_)) + 4;
    state_.assign(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]), 0);

    // Cells whose middle lies in a sphere, one run along z for each column.
    const auto middle = [&](int k, std::int64_t i) { return origin_[k] + step_ * (static_cast<double>(i) + 0.5); };
    const auto first_cell = [&](int k, double x) { return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil((x - origin_[k]) / step_ - 0.5))); };
    for (const Sphere& s : spheres) {
        for (std::int64_t x = first_cell(0, s.centre.x() - s.radius); x < size_[0] && middle(0, x) <= s.centre.x() + s.radius; ++x) {
            const double dx = middle(0, x) - s.centre.x();
            for (std::int64_t y = first_cell(1, s.centre.y() - s.radius); y < size_[1] && middle(1, y) <= s.centre.y() + s.radius; ++y) {
                const double dy = middle(1, y) - s.centre.y();
                const double left = s.radius * s.radius - dx * dx - dy * dy;
                if (left <= 0.0) continue;
                const double half = std::sqrt(left);
                const std::int64_t begin = first_cell(2, s.centre.z() - half), end = std::min(size_[2], first_cell(2, s.centre.z() + half));
                if (begin < end)
                    std::fill(state_.begin() + static_cast<std::ptrdiff_t>(cell(x, y, begin)), state_.begin() + static_cast<std::ptrdiff_t>(cell(x, y, end)),
                              std::uint8_t{1});
            }
        }
    }

    // Outside: what a walk from the corner reaches; a run along z at a time.
    std::vector<std::array<std::int64_t, 3>> todo = {{0, 0, 0}};
    while (!todo.empty()) {
        const auto [x, y, z] = todo.back();
        todo.pop_back();
        if (state_[cell(x, y, z)] != 0) continue;
        std::int64_t begin = z, end = z + 1;
        while (begin > 0 && state_[cell(x, y, begin - 1)] == 0) --begin;
        while (end < size_[2] && state_[cell(x, y, end)] == 0) ++end;
        for (std::int64_t k = begin; k < end; ++k) state_[cell(x, y, k)] = 2;
        const std::array<std::array<std::int64_t, 2>, 4> sides = {{{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}};
        for (const auto& [sx, sy] : sides) {
            if (sx < 0 || sy < 0 || sx >= size_[0] || sy >= size_[1]) continue;
            bool in_run = false;
            for (std::int64_t k = begin; k < end; ++k) {
                const bool free = state_[cell(sx, sy, k)] == 0;
                if (free && !in_run) todo.push_back({sx, sy, k});
                in_run = free;
            }
        }
    }
    std::size_t sealed = 0;
    for (const std::uint8_t s : state_) sealed += s == 0 ? 1 : 0;
    sealed_volume_ = static_cast<double>(sealed) * step_ * step_ * step_;
}

bool OuterSurface::reaches(const Vec3& p) const {
    std::int64_t at[3];
    for (int k = 0; k < 3; ++k) at[k] = static_cast<std::int64_t>(std::floor((p[k] - origin_[k]) / step_));
    for (std::int64_t x = std::max<std::int64_t>(0, at[0] - 1); x <= std::min(size_[0] - 1, at[0] + 1); ++x) {
        for (std::int64_t y = std::max<std::int64_t>(0, at[1] - 1); y <= std::min(size_[1] - 1, at[1] + 1); ++y) {
            for (std::int64_t z = std::max<std::int64_t>(0, at[2] - 1); z <= std::min(size_[2] - 1, at[2] + 1); ++z) {
                if (state_[cell(x, y, z)] == 2) return true;
            }
        }
    }
    return false;
}

}  // namespace pelletlab::shapegen::detail
