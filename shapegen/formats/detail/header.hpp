// The comment line that PelletLab's own exports carry, and the units of an import.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapegen/formats/formats.hpp"

namespace pelletlab::shapegen::formats::detail {

/// What detail::header_line wrote; all empty in a foreign file.
struct Header {
    std::string name, length_unit, mass_unit;
    std::optional<double> density;  ///< [kg/m³]
};

Header find_header(const std::vector<FormatFile>& files);

/// One unit of length in metres: from the option or the header. Error(bad_input) that asks for the unit when neither says it, or when they disagree.
double metre_of(const std::vector<FormatFile>& files, const Header& header, const ReadOptions& options);

/// Likewise for mass, in kilograms.
double kilogram_of(const std::vector<FormatFile>& files, const Header& header, const ReadOptions& options);

/// The first file; Error(usage) when there is none.
const FormatFile& main_file(const std::vector<FormatFile>& files);

/// The companion (never the main file) whose lower-case name ends with `ending`, or null.
const FormatFile* companion(const std::vector<FormatFile>& files, std::string_view ending);

/// Takes name and density from the header, fills in mass, volume, density and inertia from each other, and checks that they are those of a body:
/// positive, inertia positive definite. Error(bad_input) otherwise.
void finish(const FormatFile& file, const Header& header, ImportedClump& clump);

}  // namespace pelletlab::shapegen::formats::detail
