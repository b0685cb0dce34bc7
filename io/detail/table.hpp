// A table of numbers as people and programs write them: comma, semicolon, tab or blanks between the cells, a header line with names and units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace pelletlab::io::detail {

/// A cell of the header line, cut into name and unit: «x [mm]», «x (mm)».
struct TableColumn {
    std::string text;  ///< as written
    std::string name;  ///< lower case, blanks and dots turned into «_»: «pos_x»
    std::string unit;  ///< of the brackets; empty when there are none
    int column = 0;    ///< in the text, from 1
};

/// Reads line by line. Lines that begin with # or % are remarks; when all data follow a remark with as many cells as the first row, that remark is the header.
/// Tabs go before semicolons, semicolons before commas, commas before blanks as separators; where the separator is not the comma, a comma in a number is a
/// decimal comma. A byte-order mark and quotes round a cell are taken away.
class Table {
public:
    /// Reads the header. Throws Error(bad_input) for an empty text, or when no line names the columns.
    Table(std::string text, std::string file);
    Table(const Table&) = delete;  // cells look into the text
    Table& operator=(const Table&) = delete;

    const std::vector<TableColumn>& columns() const { return columns_; }

    /// Goes to the next row; false at the end. Throws Error(bad_input) for a row with another number of cells than the header.
    bool next();
    std::string_view cell(std::size_t column) const { return cells_[column].text; }
    /// NaN for an empty cell and for «nan», «na», «null», «none», «-»; Error(bad_input) with the place for anything else that is no finite number.
    double number(std::size_t column) const;
    Place place(std::size_t column) const;  ///< of the cell of the present row
    Place header_place(std::size_t column) const { return {file_, header_line_, columns_[column].column}; }

private:
    struct Cell {
        std::string_view text;
        int column = 0;
    };
    bool next_line(std::string_view& line);
    std::vector<Cell> split(std::string_view line, char separator) const;

    std::string text_, file_;
    std::size_t at_ = 0;
    int line_ = 0, header_line_ = 0;
    char separator_ = ',';
    std::vector<TableColumn> columns_;
    std::vector<Cell> cells_;
};

}  // namespace pelletlab::io::detail
