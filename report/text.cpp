#include "report/text.hpp"

#include <algorithm>

#include "report/detail/font.hpp"

namespace pelletlab::report {
namespace {

const detail::Glyph& glyph_or_box(char32_t code) {
    const detail::Glyph* glyph = detail::find_glyph(code);
    return glyph != nullptr ? *glyph : detail::missing_glyph();
}

constexpr double tracking = 0.5;  // [font units] added to every advance: opens the text a little at small sizes

}  // namespace

bool font_covers(std::string_view text) {
    const std::vector<char32_t> codes = detail::decode_utf8(text);
    return std::all_of(codes.begin(), codes.end(), [](char32_t code) { return detail::find_glyph(code) != nullptr; });
}

double text_width(std::string_view text, const TextStyle& style) {
    double units = 0.0;
    for (const char32_t code : detail::decode_utf8(text)) units += glyph_or_box(code).advance + tracking;
    return units * style.cap_height / detail::font_cap_height;
}

void draw_text(Image& image, double x, double y, std::string_view text, const TextStyle& style) {
    const double scale = style.cap_height / detail::font_cap_height, width = text_width(text, style);
    double pen = style.align == Align::left ? 0.0 : style.align == Align::centre ? -0.5 * width : -width;
    const auto place = [&](Point p) {
        const double along = pen + scale * p.x, above = scale * p.y;
        return style.upwards ? Point{x - above, y - along} : Point{x + along, y - above};
    };
    std::vector<std::vector<Point>> strokes, dots;
    for (const char32_t code : detail::decode_utf8(text)) {
        const detail::Glyph& glyph = glyph_or_box(code);
        detail::GlyphOutline drawn = detail::outline(glyph);
        for (std::vector<Point>& stroke : drawn.strokes) {
            for (Point& p : stroke) p = place(p);
            strokes.push_back(std::move(stroke));
        }
        for (const Point& dot : drawn.dots) dots.push_back({place(dot)});
        pen += scale * (glyph.advance + tracking);
    }
    const double stroke_width = style.weight * style.cap_height;
    draw_strokes(image, strokes, stroke_width, style.colour);
    draw_strokes(image, dots, 1.3 * stroke_width, style.colour);
}

}  // namespace pelletlab::report
