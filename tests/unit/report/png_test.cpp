#include <gtest/gtest.h>
#include <png.h>

#include <fstream>

#include "core/error.hpp"
#include "report/image.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

Image read_png(const std::filesystem::path& file) {
    png_image description{};
    description.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&description, file.c_str()), 0) << description.message;
    description.format = PNG_FORMAT_RGB;
    Image image{description.width, description.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(description))};
    EXPECT_NE(png_image_finish_read(&description, nullptr, image.rgb.data(), 0, nullptr), 0) << description.message;
    return image;
}

Image noise(std::uint32_t width, std::uint32_t height) {
    Image image = blank_image(width, height);
    RandomStream random(3, 3);
    for (std::uint8_t& value : image.rgb) value = static_cast<std::uint8_t>(random.bits() & 0xff);
    return image;
}

TEST(Png, WhatIsWrittenIsReadBack) {
    const testing::Folder folder;
    const Image image = noise(37, 19);
    write_png(image, folder / "noise.png");
    const Image back = read_png(folder / "noise.png");
    EXPECT_EQ(back.width, 37u);
    EXPECT_EQ(back.height, 19u);
    EXPECT_EQ(back.rgb, image.rgb);
}

TEST(Png, EqualPicturesAreEqualFiles) {
    const testing::Folder folder;
    const auto bytes = [](const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    write_png(noise(20, 20), folder / "a.png");
    write_png(noise(20, 20), folder / "b.png");
    EXPECT_EQ(bytes(folder / "a.png"), bytes(folder / "b.png"));
    EXPECT_NE(bytes(folder / "a.png").find("sRGB"), std::string::npos);
}

TEST(Png, LeavesNoTemporaryFileAndReplacesAnOldOne) {
    const testing::Folder folder;
    write_png(noise(5, 5), folder / "a.png");
    write_png(noise(9, 5), folder / "a.png");
    EXPECT_EQ(read_png(folder / "a.png").width, 9u);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png.part"));
}

TEST(Png, SaysWhichFileCannotBeWritten) {
    const testing::Folder folder;
    try {
        write_png(noise(5, 5), folder / "missing" / "a.png");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        EXPECT_EQ(error.place().file, (folder / "missing" / "a.png").string());
    }
    std::filesystem::create_directories(folder / "taken.png" / "inside");  // a folder in the file's place: the rename fails
    EXPECT_THROW(write_png(noise(5, 5), folder / "taken.png"), Error);
    EXPECT_FALSE(std::filesystem::exists(folder / "taken.png.part"));
    EXPECT_THROW(write_png(Image{}, folder / "empty.png"), Error);
}

}  // namespace
}  // namespace pelletlab::report
