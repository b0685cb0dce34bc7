#include "report/chart.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "core/error.hpp"

namespace pelletlab::report {
namespace {

std::size_t pixels_of(const Image& image, const Srgb& colour) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
        count += image.rgb[i] == colour[0] && image.rgb[i + 1] == colour[1] && image.rgb[i + 2] == colour[2] ? 1 : 0;
    return count;
}

Chart small_chart() {
    Chart chart;
    chart.title = "error and cost";
    chart.horizontal = {"cost", true};
    chart.vertical = {"error (mm)", true};
    chart.series.push_back({"ours", {{0.5, 0.05}, {2.0, 0.02}}, {}, {200, 30, 30}, Marker::disc, true, false});
    chart.series.push_back({"theirs", {{1.0, 0.06}}, {"Shape 2"}, {30, 30, 200}, Marker::square, false, false});
    return chart;
}

TEST(Chart, LogTicksArePowersWithTwoAndFiveBetween) {
    EXPECT_EQ(log_ticks(0.9, 12.0), (std::vector<double>{1.0, 2.0, 5.0, 10.0}));
    EXPECT_EQ(log_ticks(1e-3, 1e4).size(), 8u);   // many decades: the powers only
    EXPECT_EQ(log_ticks(0.22, 0.75).size(), 4u);  // less than a decade: more between them
    EXPECT_THROW(log_ticks(0.0, 1.0), Error);
    EXPECT_THROW(log_ticks(2.0, 1.0), Error);
}

TEST(Chart, DrawsEverySeriesInItsColourTwiceWithTheKey) {
    PictureSettings settings;
    settings.width = 800;
    Chart chart = small_chart();
    const Image image = picture_of_chart(chart, settings);
    EXPECT_EQ(image.width, 800u);
    EXPECT_EQ(image.height, 500u);
    const std::size_t square = pixels_of(image, {30, 30, 200});
    EXPECT_GT(pixels_of(image, {200, 30, 30}), square);  // two discs and a line
    // The marker's area in the plot and again in the key: side 0.88 · 11 · 800/1200 = 6.5 pixels, fully covered inside 5 × 5.
    EXPECT_GE(square, 50u);
    chart.series.pop_back();
    EXPECT_EQ(pixels_of(picture_of_chart(chart, settings), {30, 30, 200}), 0u);
}

/// Mean place of the pixels of a colour.
std::pair<double, double> middle_of(const Image& image, const Srgb& colour) {
    double x_sum = 0.0, y_sum = 0.0, count = 0.0;
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < image.width; ++x) {
            const std::uint8_t* p = &image.rgb[3 * (y * image.width + x)];
            if (p[0] == colour[0] && p[1] == colour[1] && p[2] == colour[2]) x_sum += static_cast<double>(x), y_sum += static_cast<double>(y), ++count;
        }
    return {x_sum / count, y_sum / count};
}

TEST(Chart, HigherErrorIsHigherUpAndMoreCostFartherRight) {
    PictureSettings settings;
    settings.width = 800;
    Chart chart = small_chart();
    chart.series[1].points = {{0.5, 0.05}, {2.0, 0.02}};  // keeps the axes as they are
    chart.series[1].labels = {};
    chart.series[0].line = false;
    const Srgb red{200, 30, 30};
    chart.series[0].points = {{0.6, 0.045}};
    const auto dear = middle_of(picture_of_chart(chart, settings), red);
    chart.series[0].points = {{1.8, 0.022}};
    const auto cheap = middle_of(picture_of_chart(chart, settings), red);
    // The disc in the key stays where it is and is half of the red, so the middle moves half as far as the point.
    EXPECT_GT(cheap.first - dear.first, 100.0);
    EXPECT_GT(cheap.second - dear.second, 50.0);
}

TEST(Chart, WhatCannotBeDrawnIsAnError) {
    PictureSettings settings;
    EXPECT_THROW(picture_of_chart(Chart{}, settings), Error);
    Chart chart = small_chart();
    chart.series[0].points[0].x = -1.0;
    EXPECT_THROW(picture_of_chart(chart, settings), Error);
    chart = small_chart();
    chart.series[0].points[0].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(picture_of_chart(chart, settings), Error);
    chart = small_chart();
    chart.series[1].labels.push_back("one too many");
    EXPECT_THROW(picture_of_chart(chart, settings), Error);
}

}  // namespace
}  // namespace pelletlab::report
