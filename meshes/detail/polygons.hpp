// The polygons of a mesh file, read strictly: every number is looked at, every index is checked, and a fault is named with its line. The mesh library behind
// read_mesh gets only what passed here, because damaged files make it write out of bounds.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pelletlab::meshes::detail {

/// Points and polygons of three or more corners, in the unit of the file.
struct Polygons {
    std::vector<std::array<double, 3>> points;  ///< finite as 32-bit numbers
    std::vector<std::uint32_t> corners;         ///< indices into points, polygon after polygon
    std::vector<std::size_t> first_corner;      ///< (polygons + 1)

    std::size_t count() const { return first_corner.empty() ? 0 : first_corner.size() - 1; }
    std::size_t triangles() const { return corners.size() - 2 * count(); }
    void add(const std::vector<std::uint32_t>& polygon);
};

/// Readers of one format each. Throw Error(bad_input) with the place of the fault; lines, points, normals, colours and groups are skipped.
Polygons parse_stl(std::string_view bytes, const std::filesystem::path& file);  ///< binary or ASCII
Polygons parse_obj(std::string_view bytes, const std::filesystem::path& file);
Polygons parse_ply(std::string_view bytes, const std::filesystem::path& file);  ///< ASCII, little-endian or big-endian

/// The polygons as a plain OBJ text of 9 digits, which holds every 32-bit number.
std::string plain_obj(const Polygons& polygons);

/// Whole content of a file. Throws Error(bad_input) when it is missing, a folder, empty or not readable.
std::string read_bytes(const std::filesystem::path& file);

}  // namespace pelletlab::meshes::detail
