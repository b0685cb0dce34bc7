// Images as bytes: making, pasting, colour conversion, PNG.
#pragma once

#include <cstdint>
#include <filesystem>

#include "report/render.hpp"

namespace pelletlab::report {

using Srgb = std::array<std::uint8_t, 3>;  ///< red, green, blue as stored in a file

/// IEC 61966-2-1 transfer curve, both ways, for values in [0, 1] (clamped).
double srgb_from_linear(double linear);
double linear_from_srgb(double encoded);

Srgb srgb_bytes(const Colour& linear);                   ///< rounded to the nearest byte
Colour linear_colour(const Srgb& bytes);                 ///< the inverse
Colour mix(const Colour& a, const Colour& b, double t);  ///< (1 − t)·a + t·b

/// Image of one colour. Throws Error(bad_input) for a width or height of zero, or for more than 2^28 pixels.
Image blank_image(std::uint32_t width, std::uint32_t height, const Srgb& colour = {255, 255, 255});

/// Copies `part` into `image` with its upper left corner at (left, top); what lies outside is cut off.
void paste(Image& image, const Image& part, std::int64_t left, std::int64_t top);

/// pixel ← (1 − coverage)·pixel + coverage·colour in the encoded values; outside the image nothing happens.
void blend_pixel(Image& image, std::int64_t x, std::int64_t y, const Srgb& colour, double coverage);

}  // namespace pelletlab::report
