// pellet.clump.toml: a clump template as text, exact to the last bit.
#pragma once

#include <filesystem>

#include "core/clump_template.hpp"

namespace pelletlab::io {

void write_clump(const ClumpTemplate& clump, const std::filesystem::path& file);
ClumpTemplate read_clump(const std::filesystem::path& file);

}  // namespace pelletlab::io
