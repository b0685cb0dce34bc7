// Tables of numbers in text files, plain or compressed with gzip: the first line that is no comment names the columns.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace pelletlab::io {

struct CsvTable {
    std::string file;
    std::vector<std::string> columns;
    int header_line = 0;
    std::vector<std::vector<std::string>> fields;  ///< rows × columns, blanks at both ends removed
    std::vector<int> lines;                        ///< line of each row, from 1

    /// Index of a column; Error(bad_input) with a suggestion when there is none.
    std::size_t column(const std::string& name) const;
    bool has_column(const std::string& name) const;
    /// The field as a number; NaN for an empty field, «nan» or «NA». Error(bad_input) with line and column (counted in characters of the cells before)
    /// otherwise.
    double number(std::size_t row, std::size_t column) const;
    Place place(std::size_t row, std::size_t column) const;
};

/// Reads comma, semicolon or tab separated text (which one: whatever splits the header most often), with «#» comment lines, CRLF or LF, optional double quotes.
/// A file that ends in .gz, or begins as gzip does, is inflated. Error(bad_input) for a row with another number of fields, a column named twice, no row at all.
CsvTable read_csv(const std::filesystem::path& file);
CsvTable parse_csv(const std::string& text, const std::string& file);

/// Content of a file, inflated when it is gzip.
std::string read_text_or_gzip(const std::filesystem::path& file);

}  // namespace pelletlab::io
