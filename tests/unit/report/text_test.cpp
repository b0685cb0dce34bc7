#include "report/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "report/detail/font.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

struct Extent {
    int left = 1 << 30, right = -1, top = 1 << 30, bottom = -1;
    bool empty() const { return right < 0; }
};

Extent inked(const Image& image) {
    Extent extent;
    for (int y = 0; y < static_cast<int>(image.height); ++y)
        for (int x = 0; x < static_cast<int>(image.width); ++x) {
            if (testing::pixel(image, static_cast<std::size_t>(x), static_cast<std::size_t>(y)) == Srgb{255, 255, 255}) continue;
            extent.left = std::min(extent.left, x);
            extent.right = std::max(extent.right, x);
            extent.top = std::min(extent.top, y);
            extent.bottom = std::max(extent.bottom, y);
        }
    return extent;
}

TEST(Text, EveryVisibleAsciiCharacterHasInkInsideItsBox) {
    TextStyle style;
    style.cap_height = 28.0;
    for (char c = '!'; c <= '~'; ++c) {
        const std::string text(1, c);
        ASSERT_TRUE(font_covers(text)) << c;
        Image image = blank_image(120, 120);
        draw_text(image, 40.0, 70.0, text, style);
        const Extent extent = inked(image);
        ASSERT_FALSE(extent.empty()) << c;
        const double slack = 3.5;  // half a stroke and the smooth rim; «j» hangs over to the left
        EXPECT_GE(extent.left, 40.0 - slack) << c;
        EXPECT_LE(extent.right, 40.0 + text_width(text, style) + slack) << c;
        EXPECT_GE(extent.top, 70.0 - 1.15 * 28.0 - slack) << c;
        EXPECT_LE(extent.bottom, 70.0 + 0.35 * 28.0 + slack) << c;
    }
}

TEST(Text, NoTwoCharactersLookAlike) {
    std::vector<std::vector<std::uint8_t>> seen;
    for (char c = '!'; c <= '~'; ++c) {
        Image image = blank_image(60, 60);
        TextStyle style;
        style.cap_height = 24.0;
        draw_text(image, 10.0, 40.0, std::string(1, c), style);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), image.rgb), 0) << c;
        seen.push_back(image.rgb);
    }
}

TEST(Text, CoversUnitsAndSigns) {
    EXPECT_TRUE(font_covers("µm m² m³ ° ± × · − – … ≤ ≥ ≈ α θ ρ φ ω « »"));
    EXPECT_FALSE(font_covers("漢"));
}

TEST(Text, UnknownCharactersShowAsABox) {
    Image image = blank_image(60, 60);
    draw_text(image, 10.0, 40.0, "漢", {});
    EXPECT_FALSE(inked(image).empty());
    EXPECT_GT(text_width("漢", {}), 0.0);
}

TEST(Text, BrokenUtf8IsReplacedNotRead) {
    const auto codes = detail::decode_utf8(std::string_view("a\xc3\xb0\xff\xe2\x88", 6));  // a, ð, a bad byte, a cut-off sequence of two bytes
    ASSERT_EQ(codes.size(), 5u);
    EXPECT_EQ(codes[0], U'a');
    EXPECT_EQ(codes[1], U'\xf0');
    EXPECT_EQ(codes[2], U'\xfffd');
    EXPECT_EQ(codes[3], U'\xfffd');
}

TEST(Text, WidthAddsUpAndScales) {
    TextStyle style;
    EXPECT_NEAR(text_width("0.25 m/s", style), text_width("0.25", style) + text_width(" m/s", style), 1e-12);
    TextStyle doubled = style;
    doubled.cap_height *= 2.0;
    EXPECT_NEAR(text_width("drum", doubled), 2.0 * text_width("drum", style), 1e-12);
    for (char digit = '0'; digit <= '9'; ++digit)
        EXPECT_DOUBLE_EQ(text_width(std::string(1, digit), style), text_width("0", style));  // columns of numbers align
}

TEST(Text, AlignsLeftCentreRightAndTurns) {
    TextStyle style;
    style.cap_height = 20.0;
    const std::string text = "HIH";
    const double width = text_width(text, style);
    for (const auto& [align, begin] : {std::pair{Align::left, 200.0}, {Align::centre, 200.0 - 0.5 * width}, {Align::right, 200.0 - width}}) {
        Image image = blank_image(400, 400);
        style.align = align;
        draw_text(image, 200.0, 200.0, text, style);
        EXPECT_NEAR(inked(image).left, begin, 4.0);
        EXPECT_NEAR(inked(image).bottom, 200.0, 2.0);
        EXPECT_NEAR(inked(image).top, 180.0, 2.5);
    }
    Image image = blank_image(400, 400);
    style.align = Align::left;
    style.upwards = true;
    draw_text(image, 200.0, 300.0, text, style);
    EXPECT_NEAR(inked(image).bottom, 300.0, 4.0);
    EXPECT_NEAR(inked(image).top, 300.0 - width, 6.0);
    EXPECT_NEAR(inked(image).right, 200.0, 2.0);
}

TEST(Text, IsCutOffAtTheImagesEdge) {
    Image image = blank_image(30, 20);
    draw_text(image, -20.0, 15.0, "a long text that does not fit", {});
    EXPECT_FALSE(inked(image).empty());
}

}  // namespace
}  // namespace pelletlab::report
