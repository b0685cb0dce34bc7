#include "report/chart.hpp"

#include <gtest/gtest.h>

#include <limits>

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

TEST(Chart, HigherErrorIsHigherUpAndMoreCostFartherRight) {
    PictureSettings settings;
    settings.width = 800;
    Chart chart = small_chart();
    chart.series[0].line = false;
    chart.series[0].name = "a";
    const Image image = picture_of_chart(chart, settings);
    std::size_t top_left = image.width, bottom_right = 0, first_row = image.height, last_row = 0;
    const std::size_t plot_end = image.width * 3 / 4;  // the key lies beyond
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < plot_end; ++x) {
            const std::uint8_t* p = &image.rgb[3 * (y * image.width + x)];
            if (p[0] != 200 || p[1] != 30 || p[2] != 30) continue;
            if (y < first_row) first_row = y, top_left = x;
            if (y >= last_row) last_row = y, bottom_right = x;
        }
    EXPECT_LT(first_row + 100, last_row);
    EXPECT_LT(top_left + 100, bottom_right);
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
