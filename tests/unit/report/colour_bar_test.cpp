#include "report/colour_bar.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "report/image.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

std::vector<std::string> texts(const Ticks& ticks) {
    std::vector<std::string> all;
    for (const double value : ticks.values) all.push_back(tick_text(value, ticks.decimals));
    return all;
}

using Texts = std::vector<std::string>;

TEST(Ticks, AreRoundAndIncludeTheEnds) {
    EXPECT_EQ(texts(nice_ticks(0.0, 0.3)), (Texts{"0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"}));
    EXPECT_EQ(texts(nice_ticks(0.0, 25.0)), (Texts{"0", "5", "10", "15", "20", "25"}));
    EXPECT_EQ(texts(nice_ticks(-0.1, 0.1, 4)), (Texts{"−0.10", "−0.05", "0.00", "0.05", "0.10"}));
    EXPECT_EQ(texts(nice_ticks(0.0, 4000.0, 4)), (Texts{"0", "1000", "2000", "3000", "4000"}));
    EXPECT_EQ(texts(nice_ticks(0.13, 0.41, 3)), (Texts{"0.2", "0.3", "0.4"}));
}

TEST(Ticks, StayInsideAndNearTheWantedCount) {
    RandomStream random(11, 0);
    for (int i = 0; i < 2000; ++i) {
        const double lower = random.normal() * std::pow(10.0, random.uniform(-6.0, 6.0)), upper = lower + std::pow(10.0, random.uniform(-6.0, 6.0));
        const Ticks ticks = nice_ticks(lower, upper, 5);
        const double slack = 1e-6 * (upper - lower);
        ASSERT_GE(ticks.values.size(), 2u) << lower << " … " << upper;
        ASSERT_LE(ticks.values.size(), 9u) << lower << " … " << upper;
        for (const double value : ticks.values) {
            ASSERT_GE(value, lower - slack);
            ASSERT_LE(value, upper + slack);
        }
    }
}

TEST(Ticks, DecimalsTellNeighboursApart) {
    RandomStream random(12, 0);
    for (int i = 0; i < 500; ++i) {
        const Texts all = texts(nice_ticks(0.0, std::pow(10.0, random.uniform(-5.0, 5.0))));
        for (std::size_t k = 1; k < all.size(); ++k) ASSERT_NE(all[k - 1], all[k]);
    }
}

TEST(Ticks, RefuseAnAxisWithoutLength) {
    EXPECT_THROW(nice_ticks(1.0, 1.0), Error);
    EXPECT_THROW(nice_ticks(2.0, 1.0), Error);
    EXPECT_THROW(nice_ticks(0.0, std::numeric_limits<double>::infinity()), Error);
}

TEST(Ticks, TextHasATrueMinusAndNoMinusZero) {
    EXPECT_EQ(tick_text(-1.5, 1), "\u22121.5");
    EXPECT_EQ(tick_text(-0.001, 1), "0.0");
    EXPECT_EQ(tick_text(12.0, 0), "12");
}

TEST(Ticks, RoundUpIsRoundAndNotBelow) {
    EXPECT_DOUBLE_EQ(round_up(0.27), 0.3);
    EXPECT_DOUBLE_EQ(round_up(0.3), 0.3);
    EXPECT_DOUBLE_EQ(round_up(8.1), 10.0);
    EXPECT_DOUBLE_EQ(round_up(1.0), 1.0);
    RandomStream random(13, 0);
    for (int i = 0; i < 1000; ++i) {
        const double value = std::pow(10.0, random.uniform(-9.0, 9.0)), round = round_up(value);
        ASSERT_GE(round, value * (1.0 - 1e-11));
        ASSERT_LE(round, value * 1.34);  // the widest gap in the list is 6 → 8
    }
    EXPECT_THROW(round_up(0.0), Error);
}

TEST(ColourBar, ShowsTheMapFromBottomToTopWithTextBeside) {
    Image image = blank_image(200, 300);
    const ColourBar bar{ColourMap::sequential, {0.0, 1.0}, "speed (m/s)", false, false};
    draw_colour_bar(image, bar, 20.0, 50.0, 20.0, 200.0, {});
    EXPECT_EQ(testing::pixel(image, 30, 52), map_srgb(ColourMap::sequential, 1.0 - 2.5 / 200.0));
    EXPECT_EQ(testing::pixel(image, 30, 247), map_srgb(ColourMap::sequential, 2.5 / 200.0));
    std::size_t beside = 0, above = 0;
    for (std::size_t y = 0; y < 300; ++y)
        for (std::size_t x = 0; x < 200; ++x) {
            if (testing::pixel(image, x, y) == Srgb{255, 255, 255}) continue;
            beside += x > 48;
            above += y < 45;
        }
    EXPECT_GT(beside, 200u);
    EXPECT_GT(above, 100u);
    EXPECT_LE(colour_bar_width(bar, 20.0, {}), 180.0);
}

TEST(ColourBar, PointedEndsOnlyWhereValuesLieBeyond) {
    const auto above = [](bool beyond) {
        Image image = blank_image(120, 200);
        draw_colour_bar(image, {ColourMap::sequential, {0.0, 1.0}, "", false, beyond}, 20.0, 50.0, 20.0, 100.0, {});
        return testing::pixel(image, 30, 42);
    };
    EXPECT_EQ(above(false), (Srgb{255, 255, 255}));
    EXPECT_EQ(above(true), map_srgb(ColourMap::sequential, 1.0));
}

}  // namespace
}  // namespace pelletlab::report
