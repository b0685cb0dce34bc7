#include "report/colour_bar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"
#include "report/draw.hpp"

namespace pelletlab::report {
namespace {

constexpr double tick_gap = 0.75;  // between bar and numbers, in cap heights

}  // namespace

Ticks nice_ticks(double lower, double upper, int count) {
    if (!std::isfinite(lower) || !std::isfinite(upper) || !(lower < upper) || count < 1) throw bad_input("an axis needs two finite ends, the lower one first");
    const double rough = (upper - lower) / count;
    const int power = static_cast<int>(std::floor(std::log10(rough)));
    const double mantissa = rough / std::pow(10.0, power);
    const double digit = mantissa < 1.5 ? 1.0 : mantissa < 3.5 ? 2.0 : mantissa < 7.5 ? 5.0 : 10.0;
    const double step = digit * std::pow(10.0, power);
    Ticks ticks;
    ticks.decimals = std::max(0, digit == 10.0 ? -power - 1 : -power);
    const double slack = 1e-9 * (upper - lower) / step;  // an end that is a multiple up to rounding gets its tick
    for (double k = std::ceil(lower / step - slack); k <= std::floor(upper / step + slack); k += 1.0) ticks.values.push_back(k * step);
    return ticks;
}

std::string tick_text(double value, int decimals) {
    char digits[64];
    std::snprintf(digits, sizeof digits, "%.*f", decimals, std::abs(value));
    const std::string text = digits;
    const bool zero = text.find_first_not_of("0.") == std::string::npos;
    return value < 0.0 && !zero ? "\u2212" + text : text;
}

double round_up(double value) {
    if (!std::isfinite(value) || !(value > 0.0)) throw bad_input("only a positive number can be rounded up");
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double digit : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (digit * power >= value * (1.0 - 1e-12)) return digit * power;
    return 10.0 * power;
}

void draw_colour_bar(Image& image, const ColourBar& bar, double left, double top, double width, double height, const TextStyle& style) {
    const double right = left + width, bottom = top + height, line = std::max(1.0, 0.09 * style.cap_height);
    for (double y = std::floor(top); y < bottom; y += 1.0) {
        const double from = std::max(y, top), to = std::min(y + 1.0, bottom);
        fill_rectangle(image, left, from, right, to, map_srgb(bar.map, (bottom - 0.5 * (from + to)) / height));
    }
    const double point = 0.8 * width;
    std::vector<Point> frame = {{left, top}};
    if (bar.some_above) frame.push_back({0.5 * (left + right), top - point});
    frame.push_back({right, top});
    frame.push_back({right, bottom});
    if (bar.some_below) frame.push_back({0.5 * (left + right), bottom + point});
    frame.push_back({left, bottom});
    if (bar.some_above) fill_convex(image, std::vector<Point>{{left, top}, frame[1], {right, top}}, map_srgb(bar.map, 1.0));
    if (bar.some_below) fill_convex(image, std::vector<Point>{{left, bottom}, {0.5 * (left + right), bottom + point}, {right, bottom}}, map_srgb(bar.map, 0.0));
    frame.push_back(frame.front());
    draw_strokes(image, {&frame, 1}, line, style.colour, 0.8);

    const Ticks ticks = nice_ticks(bar.range.lower, bar.range.upper, static_cast<int>(std::clamp(height / (4.0 * style.cap_height), 2.0, 6.0)));
    TextStyle numbers = style;
    numbers.align = Align::left;
    for (const double value : ticks.values) {
        const double y = bottom - height * bar.range.fraction(value);
        draw_line(image, {right, y}, {right + 0.35 * style.cap_height, y}, line, style.colour, 0.8);
        draw_text(image, right + tick_gap * style.cap_height, y + 0.5 * style.cap_height, tick_text(value, ticks.decimals), numbers);
    }
    draw_text(image, left, top - (bar.some_above ? point : 0.0) - 1.2 * style.cap_height, bar.label, numbers);
}

double colour_bar_width(const ColourBar& bar, double width, const TextStyle& style) {
    const Ticks ticks = nice_ticks(bar.range.lower, bar.range.upper);
    double numbers = 0.0;
    for (const double value : ticks.values) numbers = std::max(numbers, text_width(tick_text(value, ticks.decimals), style));
    return std::max(width + tick_gap * style.cap_height + numbers, text_width(bar.label, style));
}

}  // namespace pelletlab::report
