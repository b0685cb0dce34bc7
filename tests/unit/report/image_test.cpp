#include "report/image.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace pelletlab::report {
namespace {

TEST(Image, SrgbFollowsTheStandard) {
    EXPECT_DOUBLE_EQ(srgb_from_linear(0.0), 0.0);
    EXPECT_DOUBLE_EQ(srgb_from_linear(1.0), 1.0);
    EXPECT_NEAR(srgb_from_linear(0.18), 0.46135612950044164, 1e-12);  // middle grey, 1.055·0.18^(1/2.4) − 0.055
    EXPECT_NEAR(srgb_from_linear(0.001), 0.01292, 1e-15);
    EXPECT_DOUBLE_EQ(srgb_from_linear(2.0), 1.0);
    EXPECT_DOUBLE_EQ(srgb_from_linear(-1.0), 0.0);
}

TEST(Image, EveryByteSurvivesTheWayToLinearAndBack) {
    for (int byte = 0; byte < 256; ++byte) {
        const auto b = static_cast<std::uint8_t>(byte);
        EXPECT_EQ(srgb_bytes(linear_colour({b, b, b}))[1], b);
    }
}

TEST(Image, RefusesNoPixelsAndTooManyPixels) {
    EXPECT_THROW(blank_image(0, 10), Error);
    EXPECT_THROW(blank_image(10, 0), Error);
    EXPECT_THROW(blank_image(100000, 100000), Error);
    EXPECT_EQ(blank_image(3, 2).rgb.size(), 18u);
}

TEST(Image, PasteCutsOffWhatLiesOutside) {
    Image image = blank_image(4, 3, {0, 0, 0});
    paste(image, blank_image(3, 3, {9, 9, 9}), -1, -2);
    int bright = 0;
    for (const std::uint8_t value : image.rgb) bright += value == 9;
    EXPECT_EQ(bright, 3 * 2 * 1);
    EXPECT_EQ(image.rgb[0], 9);
    paste(image, blank_image(3, 3, {7, 7, 7}), 50, 50);
    EXPECT_EQ(image.rgb.back(), 0);
}

TEST(Image, BlendMixesAndIgnoresPixelsOutside) {
    Image image = blank_image(2, 2, {0, 100, 200});
    blend_pixel(image, 1, 0, {100, 0, 200}, 0.25);
    EXPECT_EQ(image.rgb[3], 25);
    EXPECT_EQ(image.rgb[4], 75);
    EXPECT_EQ(image.rgb[5], 200);
    const std::vector<std::uint8_t> before = image.rgb;
    blend_pixel(image, 2, 0, {1, 1, 1}, 1.0);
    blend_pixel(image, 0, -1, {1, 1, 1}, 1.0);
    EXPECT_EQ(image.rgb, before);
}

}  // namespace
}  // namespace pelletlab::report
