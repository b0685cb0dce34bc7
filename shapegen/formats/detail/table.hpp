// Sphere tables with a header line: CSV, Chrono's csv, EDEM's sphere table.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

/// Where x, y, z and r stand in a row, and what the header said about units («x [mm]»; empty without brackets).
struct SphereColumns {
    std::array<std::size_t, 4> place{0, 1, 2, 3};
    std::string length_unit;
    bool diameter = false;   ///< the fourth column is the diameter
    bool no_header = false;  ///< the first row held four numbers already
};

/// The separator of the table: the first of tab, semicolon, comma that its first row has, else blanks.
char separator_of(const std::vector<Line>& rows);

/// Cells of a row, without surrounding blanks.
std::vector<Token> cells_of(const Line& row, char separator);

/// Rows that are neither blank nor a comment («#» in front).
std::vector<Line> rows_of(const FormatFile& file);

/// Finds the columns by the names in the header: x, y, z (also «position x», «x position») and r, radius, «physical radius», d or diameter,
/// each with an optional unit in brackets. A first row of numbers alone means: no header, columns x, y, z, r. Error(bad_input) for a column missing or twice.
SphereColumns sphere_columns(const FormatFile& file, const Line& first_row, char separator);

/// Sphere of one row.
Sphere sphere_of_row(const FormatFile& file, const std::vector<Token>& cells, const SphereColumns& columns, double metre);

}  // namespace pelletlab::shapegen::formats::detail
