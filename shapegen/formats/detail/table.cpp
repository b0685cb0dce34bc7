#include "shapegen/formats/detail/table.hpp"

#include <algorithm>
#include <map>

namespace pelletlab::shapegen::formats::detail {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";
constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// Role of a column by its name: 0, 1, 2 for x, y, z, 3 for the radius, 4 for the diameter, −1 for another.
int role_of(const std::string& name) {
    static const std::map<std::string, int> roles{
        {"x", 0},          {"position x", 0}, {"x position", 0}, {"y", 1},      {"position y", 1},      {"y position", 1},        {"z", 2},
        {"position z", 2}, {"z position", 2}, {"r", 3},          {"radius", 3}, {"physical radius", 3}, {"radius (physical)", 3}, {"d", 4},
        {"diameter", 4}};
    const auto found = roles.find(name);
    return found == roles.end() ? -1 : found->second;
}

}  // namespace

char separator_of(const std::vector<Line>& rows) {
    if (rows.empty()) return ' ';
    for (const char c : {'\t', ';', ','})
        if (rows.front().text.find(c) != std::string_view::npos) return c;
    return ' ';
}

std::vector<Token> cells_of(const Line& row, char separator) {
    std::vector<Token> cells = separator == ' ' ? split(row, blanks) : split(row, std::string_view(&separator, 1), true);
    for (Token& cell : cells) {
        cell = trimmed(cell);
        if (cell.text.size() >= 2 && cell.text.front() == '"' && cell.text.back() == '"') {
            cell.text = cell.text.substr(1, cell.text.size() - 2);
            ++cell.column;
        }
    }
    return cells;
}

std::vector<Line> rows_of(const FormatFile& file) {
    std::vector<Line> rows;
    for (const Line& line : lines_of(file)) {
        const std::size_t first = line.text.find_first_not_of(blanks);
        if (first != std::string_view::npos && line.text[first] != '#') rows.push_back(line);
    }
    return rows;
}

SphereColumns sphere_columns(const FormatFile& file, const Line& first_row, char separator) {
    const std::vector<Token> cells = cells_of(first_row, separator);
    SphereColumns columns;
    if (cells.size() >= 4 && std::all_of(cells.begin(), cells.end(), [](const Token& cell) { return parse_number(cell.text).has_value(); })) {
        columns.no_header = true;
        return columns;
    }
    std::array<std::size_t, 4> place{nowhere, nowhere, nowhere, nowhere};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::string name = lower_case(cells[i].text);
        std::string unit;
        if (const std::size_t bracket = name.find('['); bracket != std::string::npos) {
            const std::size_t close = cells[i].text.find(']', bracket);
            if (close == std::string_view::npos)
                throw bad_input("the bracket of the unit is not closed in " + quoted(cells[i].text), {}, place_of(file, cells[i]));
            unit = std::string(cells[i].text.substr(bracket + 1, close - bracket - 1));
            name = std::string(trimmed({std::string_view(name).substr(0, bracket), 0, 0}).text);
        }
        int role = role_of(name);
        if (role < 0) continue;
        if (role == 4) {
            columns.diameter = true;
            role = 3;
        }
        const std::size_t index = static_cast<std::size_t>(role);
        if (place[index] != nowhere) throw bad_input("the column " + quoted(cells[i].text) + " is there twice", "keep one of them", place_of(file, cells[i]));
        place[index] = i;
        if (!unit.empty() && !columns.length_unit.empty() && unit != columns.length_unit)
            throw bad_input("the columns have different units: " + quoted(columns.length_unit) + " and " + quoted(unit), "use one unit of length",
                            place_of(file, cells[i]));
        if (!unit.empty()) columns.length_unit = unit;
    }
    constexpr std::array<const char*, 4> names{"x", "y", "z", "radius"};
    for (std::size_t k = 0; k < 4; ++k)
        if (place[k] == nowhere)
            throw bad_input(std::string("the header names no column ") + names[k], "the columns are called x, y, z, radius", {file.name, first_row.number, 1});
    columns.place = place;
    return columns;
}

Sphere sphere_of_row(const FormatFile& file, const std::vector<Token>& cells, const SphereColumns& columns, double metre) {
    const std::size_t needed = *std::max_element(columns.place.begin(), columns.place.end()) + 1;
    if (cells.size() < needed)
        throw bad_input("this row has " + std::to_string(cells.size()) + " cell(s), the header needs " + std::to_string(needed), {},
                        cells.empty() ? Place{file.name} : place_of(file, cells.back()));
    Sphere s = sphere(file, cells[columns.place[0]], cells[columns.place[1]], cells[columns.place[2]], cells[columns.place[3]], metre);
    if (columns.diameter) s.radius *= 0.5;
    return s;
}

}  // namespace pelletlab::shapegen::formats::detail
