// Perceptual colour maps: numbers to colours that grow evenly brighter, or part evenly from a neutral middle.
#pragma once

#include "report/image.hpp"

namespace pelletlab::report {

enum class ColourMap {
    sequential,  ///< viridis: dark blue – green – yellow
    diverging    ///< cool–warm: blue – light grey – red
};

/// Colour at t ∈ [0, 1] (clamped; NaN gives light grey). Encoded values, for flat areas and bars.
Srgb map_srgb(ColourMap map, double t);
/// The same as linear light, for the renderer.
Colour map_colour(ColourMap map, double t);

/// Values that the ends of a map stand for.
struct ValueRange {
    double lower = 0.0, upper = 1.0;
    double fraction(double value) const { return upper > lower ? (value - lower) / (upper - lower) : 0.5; }
};

}  // namespace pelletlab::report
