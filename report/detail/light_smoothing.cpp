#include "report/detail/light_smoothing.hpp"

#include <algorithm>

namespace pelletlab::report::detail {

LightSmoothing::LightSmoothing(const Band& band, bool ground) : band_(band) {
    if (!ground) return;
    const std::int64_t columns = band.width + 1, rows = band.bottom - band.top + 1;
    ground_.resize(static_cast<std::size_t>(columns * rows));
    for (std::int64_t y = band.top; y < band.bottom; ++y) {
        Sums row;
        for (std::int64_t x = 0; x < band.width; ++x) {
            const PixelRecord& record = band.at(x, y);
            if (record.thing == PixelRecord::ground) {
                row.key += static_cast<double>(record.key_seen);
                row.sky += static_cast<double>(record.sky_seen);
                row.count += 1.0;
            }
            const auto here = static_cast<std::size_t>((y - band.top + 1) * columns + x + 1);
            const Sums& above = ground_[here - static_cast<std::size_t>(columns)];
            ground_[here] = {above.key + row.key, above.sky + row.sky, above.count + row.count};
        }
    }
}

Light LightSmoothing::colour(std::int64_t x, std::int64_t y) const {
    constexpr float same_way = 0.97f;  // cosine: 14°
    const PixelRecord& here = band_.at(x, y);
    if (!here.smooth()) return here.colour(here.key_seen, here.sky_seen);
    const bool on_ground = here.thing == PixelRecord::ground;
    const std::int64_t radius = on_ground ? ground_smoothing_radius : smoothing_radius;
    const std::int64_t top = std::max(y - radius, band_.top), bottom = std::min(y + radius + 1, band_.bottom);
    const std::int64_t left = std::max<std::int64_t>(x - radius, 0), right = std::min(x + radius + 1, band_.width);
    if (on_ground) {
        const auto until = [&](std::int64_t u, std::int64_t v) { return ground_[static_cast<std::size_t>((v - band_.top) * (band_.width + 1) + u)]; };
        const Sums a = until(left, top), b = until(right, top), c = until(left, bottom), d = until(right, bottom);
        const double count = d.count - b.count - c.count + a.count;
        return here.colour(static_cast<float>((d.key - b.key - c.key + a.key) / count), static_cast<float>((d.sky - b.sky - c.sky + a.sky) / count));
    }
    float key = 0.0f, sky = 0.0f, count = 0.0f;
    for (std::int64_t v = top; v < bottom; ++v)
        for (std::int64_t u = left; u < right; ++u) {
            const PixelRecord& there = band_.at(u, v);
            if (there.thing != here.thing || there.normal.dot(here.normal) < same_way) continue;
            key += there.key_seen;
            sky += there.sky_seen;
            count += 1.0f;
        }
    return here.colour(key / count, sky / count);
}

}  // namespace pelletlab::report::detail
