// Which part of a union's surface the outside can reach: holes sealed inside a clump touch nothing and must not count as surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen::detail {

/// Flood fill from outside over a grid of `resolution` cells along the longest edge of the box.
class OuterSurface {
public:
    OuterSurface(std::span<const Sphere> spheres, int resolution = 128);

    /// For a point on the union's surface: does a cell of the outside lie within one cell of it?
    bool reaches(const Vec3& p) const;
    double sealed_volume() const { return sealed_volume_; }  ///< [m³], of cells that are neither in a sphere nor outside

private:
    std::size_t cell(std::int64_t x, std::int64_t y, std::int64_t z) const { return static_cast<std::size_t>((x * size_[1] + y) * size_[2] + z); }

    Vec3 origin_ = Vec3::Zero();
    double step_ = 1.0;
    std::int64_t size_[3] = {0, 0, 0};
    std::vector<std::uint8_t> state_;  // 0 free, 1 in a sphere, 2 outside
    double sealed_volume_ = 0.0;
};

}  // namespace pelletlab::shapegen::detail
