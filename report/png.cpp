// PNG through libpng: 8 bits a channel, marked as sRGB, no time stamp, so that equal pictures are equal files.
#include <png.h>

#include <cstdio>
#include <memory>
#include <string>
#include <system_error>

#include "core/error.hpp"
#include "report/render.hpp"

namespace pelletlab::report {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

void write_to(std::FILE* file, const Image& image, const std::string& name) {
    png_image description{};
    description.version = PNG_IMAGE_VERSION;
    description.width = image.width;
    description.height = image.height;
    description.format = PNG_FORMAT_RGB;
    if (png_image_write_to_stdio(&description, file, 0, image.rgb.data(), 0, nullptr) == 0) {
        const std::string message = description.message;
        png_image_free(&description);
        throw bad_input("the picture cannot be written: " + message, "is the disk full?", {name});
    }
    if (std::fflush(file) != 0 || std::ferror(file) != 0) throw bad_input("the picture cannot be written", "is the disk full?", {name});
}

}  // namespace

void write_png(const Image& image, const std::filesystem::path& file) {
    const std::string name = file.string();
    if (image.width == 0 || image.height == 0 || image.rgb.size() != std::size_t{3} * image.width * image.height)
        throw bad_input("an empty picture cannot be written", {}, {name});
    std::filesystem::path temporary = file;
    temporary += ".part";
    std::error_code ignored;
    try {
        std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(temporary.c_str(), "wb"));
        if (!stream) throw bad_input("the picture cannot be written", "does its folder exist, and may you write there?", {name});
        write_to(stream.get(), image, name);
        stream.reset();
        std::error_code failure;
        std::filesystem::rename(temporary, file, failure);
        if (failure) throw bad_input("the picture cannot be moved to its place: " + failure.message(), {}, {name});
    } catch (...) {
        std::filesystem::remove(temporary, ignored);
        throw;
    }
}

}  // namespace pelletlab::report
