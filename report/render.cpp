#include "report/render.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/progress.hpp"
#include "report/detail/light_smoothing.hpp"
#include "report/detail/painter.hpp"
#include "report/image.hpp"

namespace pelletlab::report {
namespace {

using namespace detail;

/// Two neighbouring middles of pixels see one smooth surface: same thing, nearly the same normal, no step between them.
bool one_surface(const Sight& a, const Sight& b) {
    constexpr float same_way = 0.99f, step = 0.3f;  // cosine: 8°
    if (a.thing != b.thing) return false;
    if (a.thing == PixelRecord::nothing || a.thing == PixelRecord::ground) return true;
    const Vec3f way = b.point - a.point;
    return a.normal.dot(b.normal) >= same_way && std::abs(way.dot(a.normal)) <= step * way.norm();
}

/// Pixels waiting for their light, as many as a packet of rays serves.
class Waiting {
public:
    Waiting(const Painter& painter, std::size_t each, std::uint32_t side) : painter_(painter), each_(each), side_(side) {}
    void add(const PlainPixel& pixel) {
        pixels_.push_back(pixel);
        if (2 * each_ * (pixels_.size() + 1) > packet_size) flush();
    }
    void flush() {
        if (!pixels_.empty()) painter_.light_plain(pixels_, each_, side_);
        pixels_.clear();
    }

private:
    const Painter& painter_;
    std::size_t each_;
    std::uint32_t side_;
    std::vector<PlainPixel> pixels_;
};

/// Pixels [left, right) × [top, bottom) of the band. One ray through the middle of each tells where edges and creases are: there a pixel takes all its samples.
/// Others are plain.
void paint_tile(const Painter& painter, Band& band, std::int64_t height, std::uint32_t samples, std::int64_t left, std::int64_t top, std::int64_t right,
                std::int64_t bottom) {
    const std::int64_t x0 = std::max<std::int64_t>(0, left - 1), x1 = std::min(band.width, right + 1);
    const std::int64_t y0 = std::max<std::int64_t>(0, top - 1), y1 = std::min(height, bottom + 1), columns = x1 - x0;
    std::vector<Sight> seen(static_cast<std::size_t>(columns * (y1 - y0)));
    const auto at = [&](std::int64_t x, std::int64_t y) { return static_cast<std::size_t>((y - y0) * columns + x - x0); };
    constexpr auto packet = static_cast<std::int64_t>(packet_size);
    for (std::int64_t y = y0; y < y1; ++y)
        for (std::int64_t x = x0; x < x1; x += packet)
            painter.glance(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), {&seen[at(x, y)], static_cast<std::size_t>(std::min(packet, x1 - x))});

    std::vector<std::uint8_t> plain(seen.size(), 1);
    for (std::int64_t y = y0; y < y1; ++y)
        for (std::int64_t x = x0; x < x1; ++x)
            for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 1}, {0, 1}, {1, 1}}) {
                if (x + dx < x0 || x + dx >= x1 || y + dy >= y1) continue;
                const std::size_t a = at(x, y), b = at(x + dx, y + dy);
                if (!one_surface(seen[a], seen[b])) plain[a] = plain[b] = 0;
            }

    // The ground is smoothed more, and needs fewer rays.
    Waiting on_things(painter, std::clamp<std::size_t>(samples / 8, 1, packet_size / 2), smoothing_side(0));
    Waiting on_ground(painter, std::clamp<std::size_t>(samples / 16, 1, packet_size / 2), smoothing_side(PixelRecord::ground));
    for (std::int64_t y = top; y < bottom; ++y)
        for (std::int64_t x = left; x < right; ++x) {
            Sight& here = seen[at(x, y)];
            PixelRecord& record = band.at(x, y);
            const auto px = static_cast<std::uint32_t>(x), py = static_cast<std::uint32_t>(y);
            if (!plain[at(x, y)]) {
                record = painter.pixel(px, py);
            } else if (here.thing == PixelRecord::nothing) {
                record.open_sky = painter.background();
            } else {
                (here.thing == PixelRecord::ground ? on_ground : on_things).add({px, py, &here, &record});
            }
        }
    on_things.flush();
    on_ground.flush();
}

void paint(const Painter& painter, Band& band, std::int64_t height, std::uint32_t samples) {
    constexpr std::int64_t tile = 32;  // pixels along the edge: rays of a tile meet the same things
    const std::int64_t columns = (band.width + tile - 1) / tile, rows = (band.bottom - band.top + tile - 1) / tile;
    parallel_for(static_cast<std::size_t>(columns * rows), 1, [&](std::size_t t) {
        throw_if_interrupted();
        const std::int64_t left = static_cast<std::int64_t>(t) % columns * tile, top = band.top + static_cast<std::int64_t>(t) / columns * tile;
        const std::int64_t right = std::min(left + tile, band.width), bottom = std::min(top + tile, band.bottom);
        if (!painter.has_glass()) return paint_tile(painter, band, height, samples, left, top, right, bottom);
        for (std::int64_t y = top; y < bottom; ++y)  // glass in front may have edges anywhere
            for (std::int64_t x = left; x < right; ++x) band.at(x, y) = painter.pixel(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    });
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
        paint(painter, band, height, samples_per_pixel);
        const LightSmoothing smoothing(band, scene.ground);
        parallel_for(static_cast<std::size_t>(bottom - top), 8, [&](std::size_t row) {
            const std::int64_t y = top + static_cast<std::int64_t>(row);
            for (std::int64_t x = 0; x < band.width; ++x) {
                const Srgb bytes = dithered(smoothing.colour(x, y), x, y);
                std::copy(bytes.begin(), bytes.end(), image.rgb.begin() + 3 * (y * band.width + x));
            }
        });
    }
    return image;
}

}  // namespace pelletlab::report
