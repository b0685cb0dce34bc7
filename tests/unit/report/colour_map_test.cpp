#include "report/colour_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pelletlab::report {
namespace {

void expect_near(const Srgb& a, const Srgb& b, int tolerance) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "channel " << k;
}

double brightness(const Srgb& colour) {
    const Colour light = linear_colour(colour);
    return 0.2126 * static_cast<double>(light[0]) + 0.7152 * static_cast<double>(light[1]) + 0.0722 * static_cast<double>(light[2]);
}

TEST(ColourMap, SequentialIsMatplotlibsViridis) {
    // Entries 0, 64, 128, 191 and 255 of matplotlib's table; the polynomial is stated to be within 0.02 = 5 of 255.
    expect_near(map_srgb(ColourMap::sequential, 0.0), {68, 1, 84}, 5);
    expect_near(map_srgb(ColourMap::sequential, 64 / 255.0), {59, 82, 139}, 5);
    expect_near(map_srgb(ColourMap::sequential, 128 / 255.0), {33, 145, 140}, 5);
    expect_near(map_srgb(ColourMap::sequential, 191 / 255.0), {94, 201, 98}, 5);
    expect_near(map_srgb(ColourMap::sequential, 1.0), {253, 231, 37}, 5);
}

TEST(ColourMap, SequentialGrowsBrighterAllTheWay) {
    for (int i = 0; i < 100; ++i)
        EXPECT_LT(brightness(map_srgb(ColourMap::sequential, i / 100.0)), brightness(map_srgb(ColourMap::sequential, (i + 1) / 100.0)));
}

TEST(ColourMap, DivergingHasMorelandsEndsAndMiddle) {
    // Published ends (59, 76, 192) and (180, 4, 38), middle (221, 221, 221); ±2 for the rounding of the published Msh numbers.
    expect_near(map_srgb(ColourMap::diverging, 0.0), {59, 76, 192}, 2);
    expect_near(map_srgb(ColourMap::diverging, 0.5), {221, 221, 221}, 2);
    expect_near(map_srgb(ColourMap::diverging, 1.0), {180, 4, 38}, 2);
}

TEST(ColourMap, ClampsAndShowsNotANumberGrey) {
    EXPECT_EQ(map_srgb(ColourMap::sequential, -3.0), map_srgb(ColourMap::sequential, 0.0));
    EXPECT_EQ(map_srgb(ColourMap::sequential, 7.0), map_srgb(ColourMap::sequential, 1.0));
    const Srgb unknown = map_srgb(ColourMap::diverging, std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(unknown[0], unknown[1]);
    EXPECT_EQ(unknown[1], unknown[2]);
}

TEST(ColourMap, LinearAndEncodedColoursAgree) {
    for (int i = 0; i <= 20; ++i) EXPECT_EQ(srgb_bytes(map_colour(ColourMap::sequential, i / 20.0)), map_srgb(ColourMap::sequential, i / 20.0));
}

TEST(ColourMap, RangeTurnsValuesIntoFractions) {
    const ValueRange range{-1.0, 3.0};
    EXPECT_DOUBLE_EQ(range.fraction(-1.0), 0.0);
    EXPECT_DOUBLE_EQ(range.fraction(1.0), 0.5);
    EXPECT_DOUBLE_EQ(range.fraction(3.0), 1.0);
}

}  // namespace
}  // namespace pelletlab::report
