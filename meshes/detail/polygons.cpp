#include "meshes/detail/polygons.hpp"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.hpp"

namespace pelletlab::meshes::detail {

void Polygons::add(const std::vector<std::uint32_t>& polygon) {
    if (first_corner.empty()) first_corner.push_back(0);
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    first_corner.push_back(corners.size());
}

std::string plain_obj(const Polygons& polygons) {
    std::string text;
    text.reserve(40 * polygons.points.size() + 8 * polygons.corners.size());
    std::array<char, 96> line{};
    for (const auto& [x, y, z] : polygons.points) {
        std::snprintf(line.data(), line.size(), "v %.9g %.9g %.9g\n", static_cast<double>(static_cast<float>(x)), static_cast<double>(static_cast<float>(y)),
                      static_cast<double>(static_cast<float>(z)));
        text += line.data();
    }
    for (std::size_t p = 0; p < polygons.count(); ++p) {
        text += 'f';
        for (std::size_t c = polygons.first_corner[p]; c < polygons.first_corner[p + 1]; ++c) text += ' ' + std::to_string(polygons.corners[c] + 1U);
        text += '\n';
    }
    return text;
}

std::string read_bytes(const std::filesystem::path& file) {
    std::error_code failure;
    const auto status = std::filesystem::status(file, failure);
    if (!std::filesystem::exists(status)) throw bad_input("the mesh file does not exist", "check its name and folder", {file.string()});
    if (std::filesystem::is_directory(status)) throw bad_input("the mesh file is a folder", "name the file in it", {file.string()});
    if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(file, failure) == 0 && !failure)
        throw bad_input("the mesh file is empty", "export it again", {file.string()});
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    if (stream) content << stream.rdbuf();
    std::string bytes = content.str();
    if (!stream || stream.bad() || bytes.empty()) throw bad_input("the mesh file cannot be read", "check its permissions", {file.string()});
    return bytes;
}

}  // namespace pelletlab::meshes::detail
