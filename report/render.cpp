#include "report/render.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/progress.hpp"
#include "report/detail/painter.hpp"
#include "report/image.hpp"

namespace pelletlab::report {
namespace {

using namespace detail;

/// Records of the rows [top, bottom), row by row.
struct Band {
    std::int64_t width = 0, top = 0, bottom = 0;
    std::vector<PixelRecord> records;
    const PixelRecord& at(std::int64_t x, std::int64_t y) const { return records[static_cast<std::size_t>((y - top) * width + x)]; }
};

void paint(const Painter& painter, Band& band) {
    constexpr std::int64_t tile = 32;  // pixels along the edge: rays of a tile meet the same things
    const std::int64_t columns = (band.width + tile - 1) / tile, rows = (band.bottom - band.top + tile - 1) / tile;
    parallel_for(static_cast<std::size_t>(columns * rows), 1, [&](std::size_t t) {
        throw_if_interrupted();
        const std::int64_t left = static_cast<std::int64_t>(t) % columns * tile, top = band.top + static_cast<std::int64_t>(t) / columns * tile;
        for (std::int64_t y = top; y < std::min(top + tile, band.bottom); ++y)
            for (std::int64_t x = left; x < std::min(left + tile, band.width); ++x)
                band.records[static_cast<std::size_t>((y - band.top) * band.width + x)] =
                    painter.pixel(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    });
}

constexpr std::int64_t smoothing_radius = 3, ground_smoothing_radius = 7;  // [pixel]; the ground is flat and shows noise most

/// Colour of a pixel, the shares of light that reach it averaged over neighbours on the same thing that face nearly the same way.
Light smoothed(const Band& band, std::int64_t x, std::int64_t y) {
    constexpr float same_way = 0.97f;  // cosine: 14°
    const PixelRecord& here = band.at(x, y);
    if (!here.smooth()) return here.colour(here.key_seen, here.sky_seen);
    const std::int64_t radius = here.thing == PixelRecord::ground ? ground_smoothing_radius : smoothing_radius;
    float key = 0.0f, sky = 0.0f, count = 0.0f;
    for (std::int64_t v = std::max(y - radius, band.top); v <= std::min(y + radius, band.bottom - 1); ++v)
        for (std::int64_t u = std::max<std::int64_t>(x - radius, 0); u <= std::min(x + radius, band.width - 1); ++u) {
            const PixelRecord& there = band.at(u, v);
            if (there.thing != here.thing || there.normal.dot(here.normal) < same_way) continue;
            key += there.key_seen;
            sky += there.sky_seen;
            count += 1.0f;
        }
    return here.colour(key / count, sky / count);
}

/// Bytes of a colour, rounded up or down by a fixed pattern of the pixel's place, so that slow gradients show no steps. Whole bytes, white paper among them,
/// stay. The pattern is interleaved gradient noise (J. Jimenez 2014, "Next generation post processing in Call of Duty", SIGGRAPH course).
Srgb dithered(const Light& light, std::int64_t x, std::int64_t y) {
    const auto fraction = [](double value) { return value - std::floor(value); };
    const double noise = 0.998 * (fraction(52.9829189 * fraction(0.06711056 * static_cast<double>(x) + 0.00583715 * static_cast<double>(y))) - 0.5);
    Srgb bytes{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double level = 255.0 * srgb_from_linear(static_cast<double>(light[static_cast<Eigen::Index>(k)]));
        bytes[k] = static_cast<std::uint8_t>(std::clamp(std::lround(level + noise), 0L, 255L));
    }
    return bytes;
}

}  // namespace

Image render(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t samples_per_pixel) {
    Image image = blank_image(width, height);
    if (samples_per_pixel == 0) throw bad_input("a picture needs at least one sample per pixel");
    const CameraRays rays(camera, width, height);
    const PreparedScene prepared = prepare(scene, 0.7 * rays.pixel_size());
    const Tracer tracer(prepared);
    const Painter painter(scene, prepared, tracer, rays, studio(camera), width, samples_per_pixel);

    constexpr std::int64_t band_rows = 256;  // bounds the memory; its neighbours' rows for smoothing are painted again
    for (std::int64_t top = 0; top < height; top += band_rows) {
        const std::int64_t bottom = std::min<std::int64_t>(top + band_rows, height);
        const std::int64_t margin = scene.ground ? ground_smoothing_radius : smoothing_radius;
        Band band{width, std::max<std::int64_t>(0, top - margin), std::min<std::int64_t>(bottom + margin, height), {}};
        band.records.resize(static_cast<std::size_t>(band.width * (band.bottom - band.top)));
        paint(painter, band);
        parallel_for(static_cast<std::size_t>(bottom - top), 8, [&](std::size_t row) {
            const std::int64_t y = top + static_cast<std::int64_t>(row);
            for (std::int64_t x = 0; x < band.width; ++x) {
                const Srgb bytes = dithered(smoothed(band, x, y), x, y);
                std::copy(bytes.begin(), bytes.end(), image.rgb.begin() + 3 * (y * band.width + x));
            }
        });
    }
    return image;
}

}  // namespace pelletlab::report
