// The glyphs of PelletLab's stroke font, as paths of lines, ellipse arcs and quadratic curves.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "report/draw.hpp"

namespace pelletlab::report::detail {

/// Units: baseline 0, small letters 10, capitals 14, descenders −4.2, y upwards. A path is a list of
///   Mx,y  start a stroke;  Lx,y  line to;  Qcx,cy,x,y  quadratic curve to;  Acx,cy,rx,ry,a0,a1  ellipse arc from a0 to a1 degrees
///   (it goes on from the last stroke when that ends within 1 unit of its begin, else it starts one);  Px,y  a dot.
struct Glyph {
    char32_t code;
    double advance;
    const char* path;
};

inline constexpr double font_cap_height = 14.0;

const Glyph* find_glyph(char32_t code);                    ///< nullptr when the font lacks it
const Glyph& missing_glyph();                              ///< an empty box
std::vector<char32_t> decode_utf8(std::string_view text);  ///< bytes that are not UTF-8 become U+FFFD

struct GlyphOutline {
    std::vector<std::vector<Point>> strokes;  ///< font units
    std::vector<Point> dots;
};
GlyphOutline outline(const Glyph& glyph);

}  // namespace pelletlab::report::detail
