// Few rays to the lights from each pixel leave noise: the shares of light that reach a pixel are averaged over neighbours on the same thing.
#pragma once

#include <cstdint>
#include <vector>

#include "report/detail/painter.hpp"

namespace pelletlab::report::detail {

/// Records of the rows [top, bottom), row by row.
struct Band {
    std::int64_t width = 0, top = 0, bottom = 0;
    std::vector<PixelRecord> records;
    const PixelRecord& at(std::int64_t x, std::int64_t y) const { return records[static_cast<std::size_t>((y - top) * width + x)]; }
    PixelRecord& at(std::int64_t x, std::int64_t y) { return records[static_cast<std::size_t>((y - top) * width + x)]; }
};

/// Neighbours up to so many pixels away count; the ground is flat and shows noise most.
inline constexpr std::int64_t smoothing_radius = 3, ground_smoothing_radius = 7;

inline constexpr std::uint32_t smoothing_side(std::uint32_t thing) {
    return static_cast<std::uint32_t>(2 * (thing == PixelRecord::ground ? ground_smoothing_radius : smoothing_radius) + 1);
}

class LightSmoothing {
public:
    /// Keeps a reference to `band`.
    LightSmoothing(const Band& band, bool ground);

    /// Colour of a pixel, its shares of light averaged over the square of neighbours on the same thing that face nearly the same way.
    Light colour(std::int64_t x, std::int64_t y) const;

private:
    struct Sums {
        double key = 0.0, sky = 0.0, count = 0.0;
    };
    const Band& band_;
    std::vector<Sums> ground_;  ///< over the ground's pixels left of and above a place; exact, since shares have few bits
};

}  // namespace pelletlab::report::detail
