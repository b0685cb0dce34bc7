// Round numbers for axes and colour bars, and the bars themselves.
#pragma once

#include <string>
#include <vector>

#include "report/colour_map.hpp"
#include "report/text.hpp"

namespace pelletlab::report {

struct Ticks {
    std::vector<double> values;  ///< multiples of a step of 1, 2 or 5 times a power of ten, inside [lower, upper]
    int decimals = 0;            ///< digits after the point that tell them apart
};

/// About `count` ticks (between half and double that many). Throws Error(bad_input) unless lower < upper, both finite.
Ticks nice_ticks(double lower, double upper, int count = 5);

/// «−0.05»: fixed decimals, true minus sign, no «−0».
std::string tick_text(double value, int decimals);

/// Smallest number of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is ≥ value > 0.
double round_up(double value);

struct ColourBar {
    ColourMap map = ColourMap::sequential;
    ValueRange range;         ///< in the unit of the label
    std::string label;        ///< «speed (m/s)»
    bool some_below = false;  ///< values beyond an end exist: that end is drawn pointed
    bool some_above = false;
};

/// Upright bar with its numbers to the right and the label above it, left-aligned. (left, top) and (width, height) belong to the coloured part [pixel].
void draw_colour_bar(Image& image, const ColourBar& bar, double left, double top, double width, double height, const TextStyle& style);

/// Width of bar, ticks and label together [pixel].
double colour_bar_width(const ColourBar& bar, double width, const TextStyle& style);

}  // namespace pelletlab::report
