#include "report/draw.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

/// Black laid on white, in pixels.
double ink(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) sum += (255 - image.rgb[i]) / 255.0;
    return sum;
}

constexpr Srgb black = {0, 0, 0};

TEST(Draw, RectangleCoversItsArea) {
    Image image = blank_image(40, 30);
    fill_rectangle(image, 3.25, 4.5, 20.75, 10.1, black);
    EXPECT_NEAR(ink(image), 17.5 * 5.6, 48 * 0.5 / 255.0);  // ≤ half a grey level a pixel at the rim of 48 pixels
}

TEST(Draw, LineCoversLengthTimesWidthPlusRoundEnds) {
    Image image = blank_image(200, 150);
    draw_line(image, {20.3, 30.7}, {170.2, 110.4}, 5.0, black);
    const double length = std::hypot(149.9, 79.7);
    EXPECT_NEAR(ink(image), 5.0 * length + std::numbers::pi * 2.5 * 2.5, 0.01 * 5.0 * length);  // linear edge ramp instead of exact pixel areas: 1 %
}

TEST(Draw, CircleCoversItsRing) {
    Image image = blank_image(200, 200);
    draw_circle(image, {100.3, 99.6}, 70.0, 3.0, black);
    EXPECT_NEAR(ink(image), 2.0 * std::numbers::pi * 70.0 * 3.0, 0.01 * 2.0 * std::numbers::pi * 70.0 * 3.0);
}

TEST(Draw, ConvexPolygonCoversItsAreaInBothSenses) {
    const std::vector<Point> corners = {{10.0, 10.0}, {80.0, 25.0}, {40.0, 90.0}};
    const double area = 0.5 * std::abs((70.0 * 80.0) - (15.0 * 30.0));
    for (const bool reversed : {false, true}) {
        std::vector<Point> order = corners;
        if (reversed) std::reverse(order.begin(), order.end());
        Image image = blank_image(100, 100);
        fill_convex(image, order, black);
        EXPECT_NEAR(ink(image), area, 0.01 * area);
    }
}

TEST(Draw, CrossingStrokesLayOneCoat) {
    Image image = blank_image(60, 60);
    const std::vector<std::vector<Point>> cross = {{{10.0, 30.5}, {50.0, 30.5}}, {{30.5, 10.0}, {30.5, 50.0}}};
    draw_strokes(image, cross, 5.0, black, 0.5);
    EXPECT_EQ(testing::pixel(image, 30, 30), testing::pixel(image, 15, 30));
}

TEST(Draw, ArrowPointsAtItsTip) {
    Image image = blank_image(100, 60);
    draw_arrow(image, {10.0, 30.0}, {90.0, 30.0}, 3.0, black);
    const auto column = [&image](std::size_t x) {
        double sum = 0.0;
        for (std::size_t y = 0; y < image.height; ++y) sum += (255 - testing::pixel(image, x, y)[0]) / 255.0;
        return sum;
    };
    EXPECT_NEAR(column(40), 3.0, 0.1);
    EXPECT_GT(column(78), 2.0 * column(40));  // the head is wider than the shaft
    EXPECT_LT(column(89), column(40));
    EXPECT_EQ(column(92), 0.0);
}

TEST(Draw, NothingHappensOutsideOrWithoutNumbers) {
    Image image = blank_image(20, 20);
    draw_line(image, {-100.0, -50.0}, {-30.0, -40.0}, 3.0, black);
    draw_circle(image, {1e9, 1e9}, 5.0, 1.0, black);
    fill_rectangle(image, 50.0, 50.0, 60.0, 60.0, black);
    draw_line(image, {std::nan(""), 1.0}, {5.0, 5.0}, 1.0, black);
    draw_arrow(image, {5.0, 5.0}, {5.0, 5.0}, 1.0, black);
    EXPECT_EQ(ink(image), 0.0);
}

}  // namespace
}  // namespace pelletlab::report
