// Plain drawing on an image with smooth edges. Coordinates in pixels from the upper left corner; pixel (i, j) covers [i, i+1) × [j, j+1).
#pragma once

#include <span>
#include <vector>

#include "report/image.hpp"

namespace pelletlab::report {

struct Point {
    double x = 0.0, y = 0.0;
};

/// Broken lines with round ends and joints, all in one coat: where strokes cross, the colour is not laid on twice.
void draw_strokes(Image& image, std::span<const std::vector<Point>> strokes, double width, const Srgb& colour, double opacity = 1.0);
void draw_line(Image& image, Point from, Point to, double width, const Srgb& colour, double opacity = 1.0);
void draw_circle(Image& image, Point centre, double radius, double width, const Srgb& colour, double opacity = 1.0);

/// Exact coverage of the partly covered pixels at the rim.
void fill_rectangle(Image& image, double left, double top, double right, double bottom, const Srgb& colour, double opacity = 1.0);
/// Convex polygon, either sense of rotation; 1-pixel smooth rim.
void fill_convex(Image& image, std::span<const Point> corners, const Srgb& colour, double opacity = 1.0);

/// Lays a colour on the rectangle's part outside the circle.
void fill_outside_circle(Image& image, double left, double top, double right, double bottom, Point centre, double radius, const Srgb& colour);

/// Shaft and filled head; the tip is `to`. Arrows shorter than their head become a small head. With a rim, that many pixels round it in the rim's colour.
void draw_arrow(Image& image, Point from, Point to, double width, const Srgb& colour, double rim = 0.0, const Srgb& rim_colour = {255, 255, 255});

}  // namespace pelletlab::report
