#include "report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.hpp"
#include "report/colour_bar.hpp"
#include "report/detail/page.hpp"
#include "report/text.hpp"

namespace pelletlab::report {
namespace {

/// One axis on the page: values to pixels.
struct Scale {
    bool logarithmic = false;
    double lower = 0.0, upper = 1.0;  // of the values, or of their logarithms
    double from = 0.0, to = 1.0;      // [pixel]
    double forward(double value) const { return logarithmic ? std::log10(value) : value; }
    double pixel(double value) const { return from + (forward(value) - lower) / (upper - lower) * (to - from); }
    double value_at(double transformed) const { return logarithmic ? std::pow(10.0, transformed) : transformed; }
};

double of(const Point& p, bool horizontal) {
    return horizontal ? p.x : p.y;
}

Scale scale_of(const Chart& chart, bool horizontal) {
    const ChartAxis& axis = horizontal ? chart.horizontal : chart.vertical;
    Scale scale;
    scale.logarithmic = axis.logarithmic;
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    for (const ChartSeries& series : chart.series)
        for (std::size_t k = 0; k < series.points.size(); ++k) {
            const double value = of(series.points[k], horizontal);
            if (!std::isfinite(value) || (axis.logarithmic && !(value > 0.0)))
                throw bad_input("a point of the series «" + series.name + "» cannot be drawn on the axis «" + axis.label + "»");
            const double error = horizontal || series.errors.empty() ? 0.0 : series.errors[k];
            lower = std::min(lower, scale.forward(value) - error);
            upper = std::max(upper, scale.forward(value) + error);
        }
    if (!(lower <= upper)) throw bad_input("the chart has no points");
    const double rim = upper > lower ? 0.06 * (upper - lower) : (axis.logarithmic ? 0.5 : std::max(1e-12, 0.5 * std::abs(upper)));
    scale.lower = lower - rim;
    scale.upper = upper + rim;
    return scale;
}

struct Tick {
    double value = 0.0;
    std::string text;
};

std::string short_number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::vector<Tick> ticks_of(const Scale& scale) {
    std::vector<Tick> ticks;
    if (scale.logarithmic) {
        for (const double value : log_ticks(scale.value_at(scale.lower), scale.value_at(scale.upper))) ticks.push_back({value, short_number(value)});
    } else {
        const Ticks nice = nice_ticks(scale.lower, scale.upper, 7);
        for (const double value : nice.values) ticks.push_back({value, tick_text(value, nice.decimals)});
    }
    return ticks;
}

void draw_marker(Image& image, Marker marker, Point at, double size, const Srgb& colour) {
    const double half = 0.5 * size;
    switch (marker) {
        case Marker::none:
            break;
        case Marker::disc:
            draw_line(image, at, at, size, colour);
            break;
        case Marker::ring:
            draw_circle(image, at, half - 0.12 * size, 0.24 * size, colour);
            break;
        case Marker::square:
            fill_rectangle(image, at.x - 0.88 * half, at.y - 0.88 * half, at.x + 0.88 * half, at.y + 0.88 * half, colour);
            break;
        case Marker::diamond:
            fill_convex(image, std::vector<Point>{{at.x, at.y - 1.2 * half}, {at.x + 1.2 * half, at.y}, {at.x, at.y + 1.2 * half}, {at.x - 1.2 * half, at.y}},
                        colour);
            break;
        case Marker::cross:
            draw_line(image, {at.x - 0.8 * half, at.y - 0.8 * half}, {at.x + 0.8 * half, at.y + 0.8 * half}, 0.26 * size, colour);
            draw_line(image, {at.x - 0.8 * half, at.y + 0.8 * half}, {at.x + 0.8 * half, at.y - 0.8 * half}, 0.26 * size, colour);
            break;
    }
}

void draw_broken(Image& image, Point from, Point to, double width, double dash, const Srgb& colour) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    for (double at = 0.0; at < length; at += 2.0 * dash) {
        const double a = at / length, b = std::min(at + dash, length) / length;
        draw_line(image, {from.x + a * (to.x - from.x), from.y + a * (to.y - from.y)}, {from.x + b * (to.x - from.x), from.y + b * (to.y - from.y)}, width,
                  colour);
    }
}

void draw_frame(Image& image, const Chart& chart, const Scale& across, const Scale& up, const detail::Page& page) {
    const Srgb grid = {225, 228, 232};
    const double line = std::max(1.0, 1.2 * page.unit), tick = 7.0 * page.unit;
    TextStyle numbers = page.small;
    numbers.align = Align::centre;
    for (const Tick& t : ticks_of(across)) {
        const double x = across.pixel(t.value);
        draw_line(image, {x, up.from}, {x, up.to}, line, grid);
        draw_text(image, x, up.from + tick + 1.6 * numbers.cap_height, t.text, numbers);
    }
    numbers.align = Align::right;
    double widest = 0.0;
    for (const Tick& t : ticks_of(up)) {
        const double y = up.pixel(t.value);
        draw_line(image, {across.from, y}, {across.to, y}, line, grid);
        draw_text(image, across.from - tick, y + 0.5 * numbers.cap_height, t.text, numbers);
        widest = std::max(widest, text_width(t.text, numbers));
    }
    const std::vector<Point> frame = {{across.from, up.to}, {across.from, up.from}, {across.to, up.from}};
    draw_strokes(image, {&frame, 1}, line, page.small.colour);
    TextStyle names = page.text;
    names.align = Align::centre;
    draw_text(image, 0.5 * (across.from + across.to), up.from + tick + 4.2 * names.cap_height, chart.horizontal.label, names);
    names.upwards = true;
    draw_text(image, across.from - tick - 1.4 * names.cap_height - widest, 0.5 * (up.from + up.to), chart.vertical.label, names);
}

void draw_series(Image& image, const ChartSeries& series, const Scale& across, const Scale& up, const detail::Page& page, double marker_size) {
    std::vector<Point> places;
    for (const Point& p : series.points) places.push_back({across.pixel(p.x), up.pixel(p.y)});
    const double width = std::max(1.0, 2.2 * page.unit);
    if (series.line && series.dashed)
        for (std::size_t i = 0; i + 1 < places.size(); ++i) draw_broken(image, places[i], places[i + 1], width, 8.0 * page.unit, series.colour);
    else if (series.line && places.size() > 1)
        draw_strokes(image, {&places, 1}, width, series.colour);
    TextStyle names = page.small;
    names.colour = series.colour;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!series.errors.empty())
            draw_line(image, {places[i].x, up.pixel(series.points[i].y - series.errors[i])}, {places[i].x, up.pixel(series.points[i].y + series.errors[i])},
                      0.6 * width, series.colour);
        draw_marker(image, series.marker, places[i], marker_size, series.colour);
        if (!series.labels.empty()) draw_text(image, places[i].x + 0.9 * marker_size, places[i].y - 0.5 * marker_size, series.labels[i], names);
    }
}

}  // namespace

std::vector<double> log_ticks(double lower, double upper) {
    if (!std::isfinite(lower) || !std::isfinite(upper) || !(lower > 0.0) || !(lower < upper))
        throw bad_input("a logarithmic axis needs two positive ends, the lower one first");
    const int first = static_cast<int>(std::floor(std::log10(lower))), last = static_cast<int>(std::ceil(std::log10(upper)));
    const auto with = [&](const std::vector<double>& digits) {
        std::vector<double> found;
        for (int power = first; power <= last; ++power)
            for (const double digit : digits) {
                const double value = digit * std::pow(10.0, power);
                if (value >= lower * (1.0 - 1e-12) && value <= upper * (1.0 + 1e-12)) found.push_back(value);
            }
        return found;
    };
    std::vector<double> ticks = with(last - first > 4 ? std::vector<double>{1.0} : std::vector<double>{1.0, 2.0, 5.0});
    if (ticks.size() < 3) ticks = with({1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0});
    return ticks;
}

Image picture_of_chart(const Chart& chart, const PictureSettings& settings) {
    const detail::Page page(settings.width);
    for (const ChartSeries& series : chart.series)
        if (!series.labels.empty() && series.labels.size() != series.points.size()) throw bad_input("the series «" + series.name + "» needs one label a point");
    for (const ChartSeries& series : chart.series)
        if (!series.errors.empty() && (series.errors.size() != series.points.size() || chart.vertical.logarithmic))
            throw bad_input("the series «" + series.name + "» needs one error a point, on a linear axis");
    Scale across = scale_of(chart, true), up = scale_of(chart, false);
    const std::uint32_t height = settings.width * 5 / 8;
    Image image = blank_image(settings.width, height);
    const double marker_size = 11.0 * page.unit;
    double key = 0.0;
    for (const ChartSeries& series : chart.series)
        if (!series.points.empty()) key = std::max(key, text_width(series.name, page.text));
    across.from = page.margin + 75.0 * page.unit;
    across.to = settings.width - page.margin - key - 55.0 * page.unit;
    up.from = height - page.margin - 70.0 * page.unit;
    up.to = page.margin + 2.6 * page.title.cap_height;
    if (!(across.to - across.from > 100.0 * page.unit)) throw bad_input("the names of the series leave no room for the chart", "shorten them");
    draw_frame(image, chart, across, up, page);
    for (const ChartSeries& series : chart.series) draw_series(image, series, across, up, page, marker_size);
    double y = up.to + page.text.cap_height;
    for (auto one = chart.series.rbegin(); one != chart.series.rend(); ++one) {  // what lies on top stands first
        const ChartSeries& series = *one;
        if (series.points.empty()) continue;
        const double left = across.to + 18.0 * page.unit, middle = y - 0.5 * page.text.cap_height;
        if (series.line && series.dashed)
            draw_broken(image, {left, middle}, {left + 26.0 * page.unit, middle}, std::max(1.0, 2.2 * page.unit), 5.0 * page.unit, series.colour);
        if (series.line && !series.dashed) draw_line(image, {left, middle}, {left + 26.0 * page.unit, middle}, std::max(1.0, 2.2 * page.unit), series.colour);
        draw_marker(image, series.marker, {left + 13.0 * page.unit, middle}, marker_size, series.colour);
        draw_text(image, left + 36.0 * page.unit, y, series.name, page.text);
        y += 2.1 * page.text.cap_height;
    }
    draw_text(image, across.from, page.margin + page.title.cap_height, settings.title.value_or(chart.title), page.title);
    return image;
}

}  // namespace pelletlab::report
