// pellet.clump.toml: a clump template as text, exact to the last bit.
#pragma once

#include <filesystem>
#include <string>

#include "core/clump_template.hpp"

namespace pelletlab::io {

/// Lengths in mm, masses in mg, printed with the shortest text that reads back to the same double; a header tells the quality in words.
void write_clump(const ClumpTemplate& clump, const std::filesystem::path& file);
std::string clump_text(const ClumpTemplate& clump);

/// The bounding radius is not in the file: it is computed from the spheres. Throws Error(bad_input) with file, line and column for text that is no TOML,
/// unknown (with a suggestion), missing or mistyped keys, and for values that no clump can have: no spheres, a radius, mass or moment of inertia that is not
/// positive, principal axes that are no unit quaternion.
ClumpTemplate read_clump(const std::filesystem::path& file);
ClumpTemplate parse_clump(const std::string& text, const std::string& file_name);

}  // namespace pelletlab::io
