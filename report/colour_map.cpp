#include "report/colour_map.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::report {
namespace {

using Encoded = std::array<double, 3>;  // sRGB in [0, 1]

/// Viridis (S. van der Walt, N. Smith, CC0) as the sixth-degree polynomial fitted by M. Zucker (2019, CC0,
/// https://www.shadertoy.com/view/WlfXRN); within 0.02 of matplotlib's table.
Encoded viridis(double t) {
    constexpr double c[7][3] = {{0.2777273272234177, 0.005407344544966578, 0.3340998053353061}, {0.1050930431085774, 1.404613529898575, 1.384590162594685},
                                {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},  {-4.634230498983486, -5.799100973351585, -19.33244095627987},
                                {6.228269936347081, 14.17993336680509, 56.69055260068105},      {4.776384997670288, -13.74514537774601, -65.35303263337234},
                                {-5.435455855934631, 4.645852612178535, 26.3124352495832}};
    Encoded rgb{};
    for (std::size_t k = 0; k < 3; ++k) {
        double value = 0.0;
        for (int power = 6; power >= 0; --power) value = value * t + c[power][k];
        rgb[k] = std::clamp(value, 0.0, 1.0);
    }
    return rgb;
}

/// CIELAB (D65) to encoded sRGB.
Encoded encoded_from_lab(double lightness, double a, double b) {
    const double fy = (lightness + 16.0) / 116.0;
    const auto inverse = [](double f) { return f > 6.0 / 29.0 ? f * f * f : 3.0 * (6.0 / 29.0) * (6.0 / 29.0) * (f - 4.0 / 29.0); };
    const double x = 0.95047 * inverse(fy + a / 500.0), y = inverse(fy), z = 1.08883 * inverse(fy - b / 200.0);
    return {srgb_from_linear(3.2404542 * x - 1.5371385 * y - 0.4985314 * z), srgb_from_linear(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
            srgb_from_linear(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

/// Cool–warm map in Msh space: K. Moreland (2009), ISVC 2009, LNCS 5876:92–103; key moreland2009.
/// Made for shaded surfaces: both ends are equally dark, the middle is light grey.
Encoded cool_warm(double t) {
    constexpr double end_m = 80.0, end_s = 1.08, middle_m = 88.0;
    const bool cool = t < 0.5;
    const double end_h = cool ? -1.1 : 0.5;
    const double spin = end_s * std::sqrt(middle_m * middle_m - end_m * end_m) / (end_m * std::sin(end_s));
    const double middle_h = cool ? end_h - spin : end_h + spin;
    const double towards_middle = cool ? 2.0 * t : 2.0 - 2.0 * t;
    const double m = end_m + towards_middle * (middle_m - end_m);
    const double s = end_s * (1.0 - towards_middle);
    const double h = end_h + towards_middle * (middle_h - end_h);
    return encoded_from_lab(m * std::cos(s), m * std::sin(s) * std::cos(h), m * std::sin(s) * std::sin(h));
}

Encoded encoded(ColourMap map, double t) {
    if (std::isnan(t)) return {0.8, 0.8, 0.8};
    t = std::clamp(t, 0.0, 1.0);
    return map == ColourMap::sequential ? viridis(t) : cool_warm(t);
}

}  // namespace

Srgb map_srgb(ColourMap map, double t) {
    const Encoded rgb = encoded(map, t);
    Srgb bytes{};
    for (std::size_t k = 0; k < 3; ++k) bytes[k] = static_cast<std::uint8_t>(std::lround(255.0 * rgb[k]));
    return bytes;
}

Colour map_colour(ColourMap map, double t) {
    const Encoded rgb = encoded(map, t);
    Colour linear{};
    for (std::size_t k = 0; k < 3; ++k) linear[k] = static_cast<float>(linear_from_srgb(rgb[k]));
    return linear;
}

}  // namespace pelletlab::report
