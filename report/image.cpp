#include "report/image.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"

namespace pelletlab::report {

double srgb_from_linear(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    if (v == 1.0) return 1.0;  // white paper: most of a picture
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
    const double v = std::clamp(encoded, 0.0, 1.0);
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

Srgb srgb_bytes(const Colour& linear) {
    Srgb bytes{};
    for (std::size_t k = 0; k < 3; ++k) bytes[k] = static_cast<std::uint8_t>(std::lround(255.0 * srgb_from_linear(static_cast<double>(linear[k]))));
    return bytes;
}

Colour linear_colour(const Srgb& bytes) {
    Colour linear{};
    for (std::size_t k = 0; k < 3; ++k) linear[k] = static_cast<float>(linear_from_srgb(bytes[k] / 255.0));
    return linear;
}

Colour mix(const Colour& a, const Colour& b, double t) {
    Colour mixed{};
    const auto weight = static_cast<float>(t);
    for (std::size_t k = 0; k < 3; ++k) mixed[k] = (1.0f - weight) * a[k] + weight * b[k];
    return mixed;
}

Image blank_image(std::uint32_t width, std::uint32_t height, const Srgb& colour) {
    constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;
    if (width == 0 || height == 0) throw bad_input("a picture of " + std::to_string(width) + " × " + std::to_string(height) + " pixels cannot be drawn");
    if (std::uint64_t{width} * height > most_pixels)
        throw bad_input("a picture of " + std::to_string(width) + " × " + std::to_string(height) + " pixels is too large", "stay below 2^28 pixels");
    Image image{width, height, {}};
    image.rgb.resize(std::size_t{width} * height * 3);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = colour[i % 3];
    return image;
}

void paste(Image& image, const Image& part, std::int64_t left, std::int64_t top) {
    const std::int64_t first = std::max<std::int64_t>(0, -left);
    const std::int64_t last = std::min<std::int64_t>(part.width, std::int64_t{image.width} - left);
    if (first >= last) return;
    for (std::int64_t row = 0; row < part.height; ++row) {
        const std::int64_t y = top + row;
        if (y < 0 || y >= image.height) continue;
        const auto from = part.rgb.begin() + 3 * (row * part.width + first);
        std::copy(from, from + 3 * (last - first), image.rgb.begin() + 3 * (y * image.width + left + first));
    }
}

void blend_pixel(Image& image, std::int64_t x, std::int64_t y, const Srgb& colour, double coverage) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height || coverage <= 0.0) return;
    const double share = std::min(coverage, 1.0);
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(x));
    for (std::size_t k = 0; k < 3; ++k) {
        const double mixed = (1.0 - share) * image.rgb[at + k] + share * colour[k];
        image.rgb[at + k] = static_cast<std::uint8_t>(std::lround(mixed));
    }
}

}  // namespace pelletlab::report
