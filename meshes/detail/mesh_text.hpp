// A quick look at the bytes of a mesh file before the library parses them: how many faces it claims to hold, and where a number is not finite.
// It lets the reader prove that nothing was dropped on the way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace pelletlab::meshes::detail {

enum class MeshFormat { stl_ascii, stl_binary, obj, ply };

struct FileOutline {
    MeshFormat format = MeshFormat::stl_ascii;
    std::uint64_t faces = 0;  ///< that the file claims to hold
};

/// Outline of a file with that (lower case) extension, «stl», «obj» or «ply». Throws Error(bad_input) for a file that cannot be one: no facets of an STL, a
/// binary STL cut short, a PLY header without its end or with more elements than the file has bytes.
FileOutline outline(std::string_view bytes, const std::string& extension, const std::filesystem::path& file);

/// Line (from 1) of the first vertex coordinate of a text file that does not fit into a finite 32-bit number; 0 when there is none.
int line_of_bad_number(std::string_view text);

/// Whole content of a file. Throws Error(bad_input) when it is missing, a folder, empty or not readable.
std::string read_bytes(const std::filesystem::path& file);

}  // namespace pelletlab::meshes::detail
