// Cases as TOML with units in the text. One table of keys (io/case_keys.cpp) generates the parser, the defaults, `case new`, the JSON Schema and the reference
// page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace pelletlab::io {

/// What a case is before its file says otherwise: the values of core/case.hpp, the name of the rig, in a drum as many pellets as its fill fraction asks
/// for, and the materials and contacts of the study (docs/case-reference.md).
Case default_case(Rig rig);

/// `overrides` are «key=value» texts from the command line («drum.speed=50 rpm»), applied after the file. Throws Error(bad_input) with file,
/// line and column for unknown keys (with a suggestion), missing units, values out of range, materials or contacts that are not defined.
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
Case parse_case(const std::string& text, const std::string& file_name, const std::vector<std::string>& overrides = {});

/// A path written in a case file: as it is when absolute, else from the folder of the case file.
std::filesystem::path path_in_case(const Case& c, const std::string& path);

/// Every key with its value and unit; reads back to the same Case.
std::string resolved_case_text(const Case& c);

/// A commented starting file of a rig («tube», «drum»).
std::string new_case_text(Rig rig);

std::string case_json_schema();
std::string case_reference_markdown();

}  // namespace pelletlab::io
