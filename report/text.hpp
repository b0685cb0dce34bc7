// Text in pictures: PelletLab's own stroke font, drawn with smooth edges at any size.
#pragma once

#include <string_view>

#include "report/image.hpp"

namespace pelletlab::report {

enum class Align { left, centre, right };

struct TextStyle {
    double cap_height = 14.0;  ///< [pixel], height of a capital letter; a line needs about twice as much
    Srgb colour = {51, 58, 66};
    Align align = Align::left;
    double weight = 0.115;  ///< stroke width / cap height
    bool upwards = false;   ///< turned by 90° to read from bottom to top
};

/// Length of the text in pixels. UTF-8; characters that the font lacks count and show as an empty box.
double text_width(std::string_view text, const TextStyle& style);

/// Draws with the baseline through (x, y) [pixel]; what lies outside the image is cut off.
void draw_text(Image& image, double x, double y, std::string_view text, const TextStyle& style);

/// True when every character of the text has a glyph.
bool font_covers(std::string_view text);

}  // namespace pelletlab::report
