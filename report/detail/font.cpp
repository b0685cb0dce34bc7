#include "report/detail/font.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace pelletlab::report::detail {
namespace {

// clang-format off
constexpr Glyph glyphs[] = {
    {U' ', 6, ""},
    {U'!', 4.6, "M2.3,14 L2.3,4.6 P2.3,0.3"},
    {U'"', 7, "M2,14 L2,10.4 M5,14 L5,10.4"},
    {U'#', 12, "M4,0 L5.6,14 M7.4,0 L9,14 M1.4,4.6 L10.4,4.6 M2,9.4 L11,9.4"},
    {U'$', 11.4, "A5.7,10,3.8,3,35,270 A5.7,3.7,4.2,3.3,90,-150 M5.7,15.2 L5.7,-1.6"},
    {U'%', 15, "A3.8,10.8,2.5,3.2,0,360 M11.8,14 L3.2,0 A11.2,3.2,2.5,3.2,0,360"},
    {U'&', 13.4, "M12,0 L3.6,9.2 A5.9,11.2,2.9,2.8,205,-40 L4,6.6 A5.6,3.6,4.3,3.6,120,290 Q10,1.6 11.4,6"},
    {U'\'', 3.6, "M1.8,14 L1.8,10.4"},
    {U'(', 5.4, "A8.2,6.4,6.4,12.6,138,222"},
    {U')', 5.4, "A-2.8,6.4,6.4,12.6,42,-42"},
    {U'*', 8.6, "M4.3,14 L4.3,8 M1.7,12.5 L6.9,9.5 M1.7,9.5 L6.9,12.5"},
    {U'+', 11, "M1.5,6.4 L9.5,6.4 M5.5,10.4 L5.5,2.4"},
    {U',', 4, "M2.2,0.6 L1.2,-2.6"},
    {U'-', 7, "M1.3,5.2 L5.7,5.2"},
    {U'.', 4, "P2,0.3"},
    {U'/', 7.4, "M0.8,-1.8 L6.6,15.2"},
    {U'0', 11, "A5.5,7,4.1,7,0,360"},
    {U'1', 11, "M2.4,11 L6.2,14 L6.2,0"},
    {U'2', 11, "A5.5,10,3.9,4,165,-36 L1.5,0 L9.6,0"},
    {U'3', 11, "A5.3,10.6,3.5,3.4,150,-90 A5.3,3.6,4.1,3.6,90,-152"},
    {U'4', 11, "M7.6,0 L7.6,14 L1.1,4 L10.1,4"},
    {U'5', 11, "M8.9,14 L2.9,14 L2.2,7.6 A5.4,4.6,4.1,4.6,138,-150"},
    {U'6', 11, "M8,14 Q1.5,9.8 1.5,4.4 A5.5,4.4,4,4.4,180,540"},
    {U'7', 11, "M1.4,14 L9.6,14 L4.4,0"},
    {U'8', 11, "A5.5,10.6,3.4,3.4,-90,270 A5.5,3.6,4.1,3.6,90,450"},
    {U'9', 11, "M3,0 Q9.5,4.2 9.5,9.6 A5.5,9.6,4,4.4,0,360"},
    {U':', 4, "P2,0.3 P2,8.6"},
    {U';', 4, "M2.2,0.6 L1.2,-2.6 P2.2,8.6"},
    {U'<', 11, "M9.5,10.8 L1.5,6.4 L9.5,2"},
    {U'=', 11, "M1.5,8.4 L9.5,8.4 M1.5,4.4 L9.5,4.4"},
    {U'>', 11, "M1.5,10.8 L9.5,6.4 L1.5,2"},
    {U'?', 10, "A4.9,10.4,3.6,3.6,170,-50 Q4.9,6 4.9,4.4 P4.9,0.3"},
    {U'@', 17, "A8.4,5.6,3.2,3.8,0,360 M11.6,9.2 L11.6,4 Q11.6,1.8 13.4,1.8 Q15.6,1.8 15.6,6 A8.6,6,7,8,0,300"},
    {U'A', 12.8, "M0.8,0 L6.4,14 L12,0 M2.7,4.8 L10.1,4.8"},
    {U'B', 11.8, "M6,14 L1.7,14 L1.7,0 L6.2,0 A6.2,3.6,4.1,3.6,-90,90 L1.7,7.2 M5.6,14 A6,10.6,3.5,3.4,90,-90"},
    {U'C', 13.2, "A7.7,7,6.3,7,48,312"},
    {U'D', 13.4, "M1.7,0 L1.7,14 L5,14 A5,7,6.9,7,90,-90 L1.7,0"},
    {U'E', 10.8, "M9.4,14 L1.7,14 L1.7,0 L9.6,0 M1.7,7.2 L8.6,7.2"},
    {U'F', 10, "M9.2,14 L1.7,14 L1.7,0 M1.7,6.9 L8.3,6.9"},
    {U'G', 14.8, "A7.7,7,6.3,7,48,336 L13.5,6.4 L8.8,6.4"},
    {U'H', 13, "M1.7,0 L1.7,14 M11.3,0 L11.3,14 M1.7,7.2 L11.3,7.2"},
    {U'I', 3.4, "M1.7,0 L1.7,14"},
    {U'J', 8.4, "M6.7,14 L6.7,4 A3.7,4,3,4,0,-150"},
    {U'K', 11.8, "M1.7,14 L1.7,0 M10.6,14 L1.7,5.2 M5,8.5 L11.2,0"},
    {U'L', 9.8, "M1.7,14 L1.7,0 L9.2,0"},
    {U'M', 15.4, "M1.7,0 L1.7,14 L7.7,3.4 L13.7,14 L13.7,0"},
    {U'N', 13, "M1.7,0 L1.7,14 L11.3,0 L11.3,14"},
    {U'O', 15.2, "A7.6,7,6.2,7,0,360"},
    {U'P', 11.2, "M1.7,0 L1.7,14 L6,14 A6,10.2,3.9,3.8,90,-90 L1.7,6.4"},
    {U'Q', 15.2, "A7.6,7,6.2,7,0,360 M9.4,3.6 L13.4,-0.9"},
    {U'R', 11.8, "M1.7,0 L1.7,14 L6,14 A6,10.2,3.9,3.8,90,-90 L1.7,6.4 M6.1,6.4 L10.8,0"},
    {U'S', 11.4, "A5.8,10.4,3.9,3.6,38,270 A5.8,3.4,4.4,3.4,90,-150"},
    {U'T', 11.8, "M0.9,14 L10.9,14 M5.9,14 L5.9,0"},
    {U'U', 12.8, "M1.7,14 L1.7,4.8 A6.4,4.8,4.7,4.8,180,360 L11.1,14"},
    {U'V', 12.4, "M0.8,14 L6.2,0 L11.6,14"},
    {U'W', 18, "M0.8,14 L4.8,0 L9,13.4 L13.2,0 L17.2,14"},
    {U'X', 11.8, "M1,14 L10.8,0 M10.8,14 L1,0"},
    {U'Y', 11.6, "M0.8,14 L5.8,6.6 L10.8,14 M5.8,6.6 L5.8,0"},
    {U'Z', 11.6, "M1.2,14 L10.3,14 L1.1,0 L10.5,0"},
    {U'[', 5.6, "M4.8,15.4 L1.9,15.4 L1.9,-2.6 L4.8,-2.6"},
    {U'\\', 7.4, "M0.8,15.2 L6.6,-1.8"},
    {U']', 5.6, "M0.8,15.4 L3.7,15.4 L3.7,-2.6 L0.8,-2.6"},
    {U'^', 9, "M1.4,9.6 L4.5,14 L7.6,9.6"},
    {U'_', 10, "M0,-2.6 L10,-2.6"},
    {U'`', 6, "M1.8,14.4 L4,11.8"},
    {U'a', 10.6, "A5.2,6.6,3.6,3.4,155,0 L8.8,0 M8.8,5.8 L4.9,5.8 A4.7,2.9,3.3,2.9,90,270 Q7.6,0 8.8,2.6"},
    {U'b', 11.3, "M1.5,14 L1.5,0 A5.7,5,4.2,5,180,540"},
    {U'c', 9.8, "A5.6,5,4.2,5,48,312"},
    {U'd', 11.3, "A5.6,5,4.2,5,0,360 M9.8,14 L9.8,0"},
    {U'e', 11, "M1.4,5.1 L9.7,5.1 A5.55,5,4.15,5,0,314"},
    {U'f', 6.8, "M6.5,14 L5.9,14 Q3,14 3,10.8 L3,0 M0.7,10 L6,10"},
    {U'g', 11.3, "A5.6,5,4.2,5,0,360 M9.8,10 L9.8,-0.4 A5.8,-0.4,4,3.8,0,-150"},
    {U'h', 10.6, "M1.5,14 L1.5,0 M1.5,6 A5.3,6,3.8,4,180,0 L9.1,0"},
    {U'i', 3.4, "M1.7,10 L1.7,0 P1.7,13.5"},
    {U'j', 4, "M2.2,10 L2.2,-1.4 Q2.2,-4.2 -0.6,-4.2 P2.2,13.5"},
    {U'k', 9.4, "M1.5,14 L1.5,0 M8.2,10 L1.5,4 M4,6.3 L8.8,0"},
    {U'l', 4.4, "M1.7,14 L1.7,2.2 Q1.7,0 4,0"},
    {U'm', 15.9, "M1.5,10 L1.5,0 M1.5,6.4 A4.7,6.4,3.2,3.6,180,0 L7.9,0 M7.9,6.4 A11.1,6.4,3.2,3.6,180,0 L14.3,0"},
    {U'n', 10.6, "M1.5,10 L1.5,0 M1.5,6 A5.3,6,3.8,4,180,0 L9.1,0"},
    {U'o', 11.2, "A5.6,5,4.2,5,0,360"},
    {U'p', 11.3, "M1.5,10 L1.5,-4.2 M1.5,5 A5.7,5,4.2,5,180,540"},
    {U'q', 11.3, "A5.6,5,4.2,5,0,360 M9.8,10 L9.8,-4.2"},
    {U'r', 7, "M1.5,10 L1.5,0 M1.5,5.8 A5.4,5.8,3.9,4.2,180,72"},
    {U's', 9.2, "A4.7,7.5,3.1,2.5,32,270 A4.7,2.5,3.4,2.5,90,-150"},
    {U't', 7.2, "M3.2,13 L3.2,3 Q3.2,0 6,0 L6.4,0 M0.7,10 L6.2,10"},
    {U'u', 10.6, "M1.5,10 L1.5,4 A5.3,4,3.8,4,180,360 M9.1,10 L9.1,0"},
    {U'v', 9.6, "M0.9,10 L4.8,0 L8.7,10"},
    {U'w', 14.4, "M0.9,10 L4,0 L7.2,9.4 L10.4,0 L13.5,10"},
    {U'x', 9.6, "M1,10 L8.6,0 M8.6,10 L1,0"},
    {U'y', 9.8, "M0.9,10 L4.9,0 M8.9,10 L3.3,-4.2"},
    {U'z', 9.6, "M1.2,10 L8.3,10 L1.1,0 L8.5,0"},
    {U'{', 6.4, "M5.4,15.4 Q3.2,15.4 3.2,12.8 L3.2,8.6 Q3.2,6.4 1,6.4 Q3.2,6.4 3.2,4.2 L3.2,0 Q3.2,-2.6 5.4,-2.6"},
    {U'|', 3.6, "M1.8,15.4 L1.8,-2.6"},
    {U'}', 6.4, "M1,15.4 Q3.2,15.4 3.2,12.8 L3.2,8.6 Q3.2,6.4 5.4,6.4 Q3.2,6.4 3.2,4.2 L3.2,0 Q3.2,-2.6 1,-2.6"},
    {U'~', 11, "M1.4,5.4 Q2.4,8 5.5,6.4 Q8.6,4.8 9.6,7.4"},
    {0xab, 9.4, "M4.4,8.4 L1.4,5 L4.4,1.6 M8,8.4 L5,5 L8,1.6"},
    {0xb0, 6.4, "A3.2,11.8,2.1,2.2,0,360"},
    {0xb1, 11, "M1.5,7.8 L9.5,7.8 M5.5,11.8 L5.5,3.8 M1.5,1 L9.5,1"},
    {0xb2, 7, "A3.4,12.6,2.2,2.2,165,-36 L1.1,6.8 L5.8,6.8"},
    {0xb3, 7, "A3.3,12.9,2,1.9,150,-90 A3.3,8.9,2.3,2.1,90,-152"},
    {0xb5, 10.6, "M1.5,10 L1.5,-4.2 M1.5,4 A5.3,4,3.8,4,180,360 M9.1,10 L9.1,0"},
    {0xb7, 5, "P2.5,5.6"},
    {0xb9, 7, "M1.8,13.2 L3.8,14.8 L3.8,6.8"},
    {0xbb, 9.4, "M1.4,8.4 L4.4,5 L1.4,1.6 M5,8.4 L8,5 L5,1.6"},
    {0xd7, 11, "M2.2,9.7 L8.8,3.1 M8.8,9.7 L2.2,3.1"},
    {0xd8, 15.2, "A7.6,7,6.2,7,0,360 M2.2,-0.6 L13,14.6"},
    {0xe4, 10.6, "A5.2,6.6,3.6,3.4,155,0 L8.8,0 M8.8,5.8 L4.9,5.8 A4.7,2.9,3.3,2.9,90,270 Q7.6,0 8.8,2.6 P3.6,13.5 P6.8,13.5"},
    {0xf6, 11.2, "A5.6,5,4.2,5,0,360 P4,13.5 P7.2,13.5"},
    {0xfc, 10.6, "M1.5,10 L1.5,4 A5.3,4,3.8,4,180,360 M9.1,10 L9.1,0 P3.7,13.5 P6.9,13.5"},
    {0x3b1, 11.6, "M10.6,10 Q8.6,0 5.2,0 A5.2,5,3.8,5,270,90 Q8.4,10 10.6,0"},
    {0x3b8, 10.4, "A5.2,7,3.8,7,0,360 M1.4,7.2 L9,7.2"},
    {0x3c1, 11, "M1.5,-4.2 L1.5,5 A5.6,5,4.1,5,180,-180"},
    {0x3c6, 13, "A6.5,5,5,5,0,360 M6.5,13.4 L6.5,-4.2"},
    {0x3c9, 14, "M3.6,10 Q1.4,7.6 1.4,4.4 Q1.4,0 4.2,0 Q7,0 7,4.4 L7,6.4 M7,4.4 Q7,0 9.8,0 Q12.6,0 12.6,4.4 Q12.6,7.6 10.4,10"},
    {0x2013, 10, "M1,5.2 L9,5.2"},
    {0x2014, 15, "M1,5.2 L14,5.2"},
    {0x2019, 4, "M2.6,14 L1.6,11"},
    {0x2026, 13, "P2.2,0.3 P6.5,0.3 P10.8,0.3"},
    {0x207b, 7, "M1.3,10.6 L5.7,10.6"},
    {0x2192, 15, "M1.4,5.6 L13.4,5.6 M9.4,9.4 L13.4,5.6 L9.4,1.8"},
    {0x2212, 11, "M1.5,6.4 L9.5,6.4"},
    {0x2248, 11, "M1.4,7.6 Q2.4,10.2 5.5,8.6 Q8.6,7 9.6,9.6 M1.4,3.2 Q2.4,5.8 5.5,4.2 Q8.6,2.6 9.6,5.2"},
    {0x2264, 11, "M9.5,12 L1.5,8 L9.5,4 M1.5,0.8 L9.5,0.8"},
    {0x2265, 11, "M1.5,12 L9.5,8 L1.5,4 M1.5,0.8 L9.5,0.8"},
};
// clang-format on

constexpr Glyph box = {0xfffd, 11, "M1.5,0 L9.5,0 L9.5,14 L1.5,14 L1.5,0"};

static_assert(std::is_sorted(std::begin(glyphs), std::end(glyphs), [](const Glyph& a, const Glyph& b) { return a.code < b.code; }));

/// The numbers behind the command letter at `text`, which moves on to what follows them.
std::vector<double> numbers_after(const char*& text) {
    std::vector<double> numbers;
    do {
        ++text;  // the letter, or what separates two numbers
        char* end = nullptr;
        numbers.push_back(std::strtod(text, &end));
        text = end;
    } while (*text == ',' || (*text == ' ' && (text[1] == '-' || (text[1] >= '0' && text[1] <= '9'))));
    return numbers;
}

std::vector<Point> arc(const std::vector<double>& n) {
    const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(n[5] - n[4]) / 7.5)));
    std::vector<Point> points;
    for (int i = 0; i <= steps; ++i) {
        const double angle = (n[4] + (n[5] - n[4]) * i / steps) * std::numbers::pi / 180.0;
        points.push_back({n[0] + n[2] * std::cos(angle), n[1] + n[3] * std::sin(angle)});
    }
    return points;
}

bool goes_on(const std::vector<std::vector<Point>>& strokes, Point next) {
    return !strokes.empty() && std::hypot(strokes.back().back().x - next.x, strokes.back().back().y - next.y) < 1.0;
}

void add_curve(std::vector<Point>& stroke, const std::vector<double>& n) {
    constexpr int steps = 10;
    const Point from = stroke.back();
    for (int i = 1; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps, a = (1.0 - t) * (1.0 - t), b = 2.0 * t * (1.0 - t), c = t * t;
        stroke.push_back({a * from.x + b * n[0] + c * n[2], a * from.y + b * n[1] + c * n[3]});
    }
}

}  // namespace

const Glyph* find_glyph(char32_t code) {
    const auto* found = std::lower_bound(std::begin(glyphs), std::end(glyphs), code, [](const Glyph& glyph, char32_t wanted) { return glyph.code < wanted; });
    return found != std::end(glyphs) && found->code == code ? found : nullptr;
}

const Glyph& missing_glyph() {
    return box;
}

GlyphOutline outline(const Glyph& glyph) {
    GlyphOutline result;
    std::vector<std::vector<Point>>& strokes = result.strokes;
    for (const char* at = glyph.path; *at != '\0';) {
        const char command = *at;
        if (command == ' ') {
            ++at;
            continue;
        }
        const std::vector<double> n = numbers_after(at);
        if (command == 'P') result.dots.push_back({n[0], n[1]});
        if (command == 'M') strokes.push_back({{n[0], n[1]}});
        if (command == 'L') strokes.back().push_back({n[0], n[1]});
        if (command == 'Q') add_curve(strokes.back(), n);
        if (command == 'A') {
            const std::vector<Point> points = arc(n);
            if (!goes_on(strokes, points.front())) strokes.emplace_back();
            strokes.back().insert(strokes.back().end(), points.begin(), points.end());
        }
    }
    return result;
}

std::vector<char32_t> decode_utf8(std::string_view text) {
    std::vector<char32_t> codes;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t length = lead < 0x80 ? 1 : lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
        char32_t code = length == 1 ? lead : length == 2 ? lead & 0x1fu : length == 3 ? lead & 0x0fu : lead & 0x07u;
        bool good = length > 0 && i + length <= text.size();
        for (std::size_t k = 1; good && k < length; ++k) {
            const auto next = static_cast<unsigned char>(text[i + k]);
            good = (next & 0xc0u) == 0x80u;
            code = (code << 6) | (next & 0x3fu);
        }
        codes.push_back(good ? code : U'\xfffd');
        i += good ? length : 1;
    }
    return codes;
}

}  // namespace pelletlab::report::detail
