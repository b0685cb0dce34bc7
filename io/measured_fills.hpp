// Measured bed heights in a table: one row a repeat (pellets or mass, height), or one row a fill (mean, standard deviation, number of repeats).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/measured_fill.hpp"

namespace pelletlab::io {

/// Columns: «pellets», «mass [g]» (one of them or both), and either «height [mm]», or «mean [mm]», «sd [mm]», «n». Rows of the same pellets and mass are
/// repeats. `length_unit` stands in where a height's column names none. Throws Error(bad_input) with file, line and column for a missing column or unit, a
/// value that is no positive number, a deviation without a number of repeats, no row.
std::vector<MeasuredFill> read_measured_fills(const std::filesystem::path& file, const std::string& length_unit = {});
std::vector<MeasuredFill> parse_measured_fills(const std::string& text, const std::string& file, const std::string& length_unit = {});

}  // namespace pelletlab::io
