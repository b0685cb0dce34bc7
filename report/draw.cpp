#include "report/draw.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pelletlab::report {
namespace {

/// Part of the image [left, right) × [top, bottom) with a number a pixel.
struct Mask {
    std::int64_t left = 0, top = 0, right = 0, bottom = 0;
    std::vector<float> value;

    Mask(const Image& image, double x0, double y0, double x1, double y1) {
        const auto cut = [](double v, std::uint32_t size) { return static_cast<std::int64_t>(std::clamp(v, 0.0, static_cast<double>(size))); };
        left = cut(std::floor(x0), image.width);
        right = cut(std::ceil(x1), image.width);
        top = cut(std::floor(y0), image.height);
        bottom = cut(std::ceil(y1), image.height);
        if (left < right && top < bottom) value.assign(static_cast<std::size_t>((right - left) * (bottom - top)), 0.0f);
    }
    bool empty() const { return value.empty(); }
    float& at(std::int64_t x, std::int64_t y) { return value[static_cast<std::size_t>((y - top) * (right - left) + x - left)]; }

    /// Calls set(x, y) for the pixels of this mask inside the given box.
    template <class Set>
    void for_box(double x0, double y0, double x1, double y1, const Set& set) const {
        const auto first_x = std::max(left, static_cast<std::int64_t>(std::floor(std::max(x0, -1.0)))),
                   first_y = std::max(top, static_cast<std::int64_t>(std::floor(std::max(y0, -1.0))));
        const auto last_x = std::min(right, static_cast<std::int64_t>(std::ceil(std::min(x1, 1e9)))),
                   last_y = std::min(bottom, static_cast<std::int64_t>(std::ceil(std::min(y1, 1e9))));
        for (std::int64_t y = first_y; y < last_y; ++y)
            for (std::int64_t x = first_x; x < last_x; ++x) set(x, y);
    }
    void lay_on(Image& image, const Srgb& colour, double opacity) {
        for (std::int64_t y = top; y < bottom; ++y)
            for (std::int64_t x = left; x < right; ++x) blend_pixel(image, x, y, colour, opacity * static_cast<double>(at(x, y)));
    }
};

double distance_to_segment(double x, double y, Point a, Point b) {
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const double t = square > 0.0 ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / square, 0.0, 1.0) : 0.0;
    return std::hypot(x - a.x - t * dx, y - a.y - t * dy);
}

}  // namespace

void draw_strokes(Image& image, std::span<const std::vector<Point>> strokes, double width, const Srgb& colour, double opacity) {
    const double reach = 0.5 * width + 1.0;
    double x0 = std::numeric_limits<double>::infinity(), y0 = x0, x1 = -x0, y1 = -x0;
    for (const auto& stroke : strokes)
        for (const Point& p : stroke) {
            x0 = std::min(x0, p.x);
            x1 = std::max(x1, p.x);
            y0 = std::min(y0, p.y);
            y1 = std::max(y1, p.y);
        }
    if (!(x0 <= x1) || !std::isfinite(x0 + x1 + y0 + y1)) return;
    Mask mask(image, x0 - reach, y0 - reach, x1 + reach, y1 + reach);
    if (mask.empty()) return;
    for (const auto& stroke : strokes)
        for (std::size_t i = 0; i < stroke.size(); ++i) {
            const Point a = stroke[i], b = stroke[std::min(i + 1, stroke.size() - 1)];
            if (i + 1 == stroke.size() && stroke.size() > 1) break;
            mask.for_box(std::min(a.x, b.x) - reach, std::min(a.y, b.y) - reach, std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach,
                         [&](std::int64_t x, std::int64_t y) {
                             const double distance = distance_to_segment(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, a, b);
                             const auto coverage = static_cast<float>(std::clamp(0.5 * width + 0.5 - distance, 0.0, std::min(1.0, width)));
                             float& value = mask.at(x, y);
                             value = std::max(value, coverage);
                         });
        }
    mask.lay_on(image, colour, opacity);
}

void draw_line(Image& image, Point from, Point to, double width, const Srgb& colour, double opacity) {
    const std::vector<Point> stroke = {from, to};
    draw_strokes(image, {&stroke, 1}, width, colour, opacity);
}

void draw_circle(Image& image, Point centre, double radius, double width, const Srgb& colour, double opacity) {
    const double reach = radius + 0.5 * width + 1.0;
    Mask mask(image, centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach);
    if (mask.empty()) return;
    mask.for_box(centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach, [&](std::int64_t x, std::int64_t y) {
        const double distance = std::abs(std::hypot(static_cast<double>(x) + 0.5 - centre.x, static_cast<double>(y) + 0.5 - centre.y) - radius);
        mask.at(x, y) = static_cast<float>(std::clamp(0.5 * width + 0.5 - distance, 0.0, std::min(1.0, width)));
    });
    mask.lay_on(image, colour, opacity);
}

void fill_rectangle(Image& image, double left, double top, double right, double bottom, const Srgb& colour, double opacity) {
    Mask mask(image, left, top, right, bottom);
    if (mask.empty()) return;
    const auto overlap = [](std::int64_t pixel, double lower, double upper) {
        return std::max(0.0, std::min(upper, static_cast<double>(pixel) + 1.0) - std::max(lower, static_cast<double>(pixel)));
    };
    mask.for_box(left, top, right, bottom,
                 [&](std::int64_t x, std::int64_t y) { mask.at(x, y) = static_cast<float>(overlap(x, left, right) * overlap(y, top, bottom)); });
    mask.lay_on(image, colour, opacity);
}

void fill_convex(Image& image, std::span<const Point> corners, const Srgb& colour, double opacity) {
    if (corners.size() < 3) return;
    double x0 = corners[0].x, x1 = x0, y0 = corners[0].y, y1 = y0, area = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point a = corners[i], b = corners[(i + 1) % corners.size()];
        x0 = std::min(x0, a.x);
        x1 = std::max(x1, a.x);
        y0 = std::min(y0, a.y);
        y1 = std::max(y1, a.y);
        area += a.x * b.y - a.y * b.x;
    }
    if (!std::isfinite(area) || area == 0.0) return;
    const double sense = area > 0.0 ? 1.0 : -1.0;
    Mask mask(image, x0 - 1.0, y0 - 1.0, x1 + 1.0, y1 + 1.0);
    if (mask.empty()) return;
    mask.for_box(x0 - 1.0, y0 - 1.0, x1 + 1.0, y1 + 1.0, [&](std::int64_t x, std::int64_t y) {
        double inside = std::numeric_limits<double>::infinity();  // distance to the nearest side's line
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Point a = corners[i], b = corners[(i + 1) % corners.size()];
            const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
            if (length > 0.0)
                inside = std::min(inside, sense * (dx * (static_cast<double>(y) + 0.5 - a.y) - dy * (static_cast<double>(x) + 0.5 - a.x)) / length);
        }
        mask.at(x, y) = static_cast<float>(std::clamp(inside + 0.5, 0.0, 1.0));
    });
    mask.lay_on(image, colour, opacity);
}

void fill_outside_circle(Image& image, double left, double top, double right, double bottom, Point centre, double radius, const Srgb& colour) {
    Mask mask(image, left, top, right, bottom);
    if (mask.empty()) return;
    mask.for_box(left, top, right, bottom, [&](std::int64_t x, std::int64_t y) {
        const double distance = std::hypot(static_cast<double>(x) + 0.5 - centre.x, static_cast<double>(y) + 0.5 - centre.y);
        mask.at(x, y) = static_cast<float>(std::clamp(distance - radius + 0.5, 0.0, 1.0));
    });
    mask.lay_on(image, colour, 1.0);
}

void draw_arrow(Image& image, Point from, Point to, double width, const Srgb& colour, double rim, const Srgb& rim_colour) {
    const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
    if (!(length > 0.0)) return;
    const double head = std::min(4.2 * width, length), half = 0.42 * head;
    const Point base = {to.x - dx / length * head, to.y - dy / length * head};
    const std::vector<Point> corners = {
        to, {base.x - dy / length * half, base.y + dx / length * half}, {base.x + dy / length * half, base.y - dx / length * half}};
    const Point neck = {base.x + 0.3 * width * dx / length, base.y + 0.3 * width * dy / length};
    if (rim > 0.0) {
        if (length > head) draw_line(image, from, neck, width + 2.0 * rim, rim_colour);
        std::vector<Point> closed = corners;
        closed.push_back(to);
        draw_strokes(image, {&closed, 1}, 2.0 * rim, rim_colour);
    }
    if (length > head) draw_line(image, from, neck, width, colour);
    fill_convex(image, corners, colour);
}

}  // namespace pelletlab::report
