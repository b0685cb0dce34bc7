#include "io/detail/table.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace pelletlab::io::detail {

namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

bool is_remark(std::string_view line) {
    return !line.empty() && (line.front() == '#' || line.front() == '%');
}

char separator_of(std::string_view line) {
    for (const char separator : {'\t', ';', ','})
        if (line.find(separator) != std::string_view::npos) return separator;
    return ' ';
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

bool stands_for_nothing(std::string_view text) {
    if (text.empty() || text == "-") return true;
    const std::string word = lower(text);
    return word == "nan" || word == "na" || word == "n/a" || word == "null" || word == "none";
}

/// False when the text is no number; an infinite or too large one is none either.
bool parse_number(std::string_view text, bool decimal_comma, double& value) {
    std::string replaced;
    if (decimal_comma && text.find(',') != std::string_view::npos) {
        replaced = text;
        std::replace(replaced.begin(), replaced.end(), ',', '.');
        text = replaced;
    }
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    return result.ec == std::errc() && result.ptr == text.data() + text.size() && std::isfinite(value);
}

TableColumn column_of(std::string_view text, int place) {
    TableColumn column;
    column.text = text;
    column.column = place;
    std::string_view name = text;
    const std::size_t open = text.find_first_of("[(");
    if (open != std::string_view::npos && (text.back() == ']' || text.back() == ')')) {
        column.unit = trimmed(text.substr(open + 1, text.size() - open - 2));
        name = trimmed(text.substr(0, open));
    }
    column.name = lower(name);
    for (char& c : column.name)
        if (c == ' ' || c == '.' || c == '-' || c == ':') c = '_';
    return column;
}

}  // namespace

Table::Table(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    std::string_view line, remark;
    int remark_line = 0;
    bool found = false;
    std::size_t line_begin = at_;  // of the first row
    for (; next_line(line); line_begin = at_) {
        if (trimmed(line).empty()) continue;
        if (is_remark(trimmed(line))) {
            remark = line;
            remark_line = line_;
            continue;
        }
        found = true;
        break;
    }
    if (!found) throw bad_input("the table has no rows", "give a file with a header line and one row a pellet and time", {file_});
    separator_ = separator_of(trimmed(line));
    header_line_ = line_;
    std::vector<Cell> header = split(line, separator_);
    double ignored = 0.0;
    const bool comma = separator_ != ',';
    const bool numbers_only = std::all_of(header.begin(), header.end(), [&](const Cell& cell) { return parse_number(cell.text, comma, ignored); });
    if (numbers_only) {  // the header may be the remark above
        const std::size_t names_at = std::min(remark.find_first_not_of("#% \t"), remark.size());
        const std::string_view names = remark.substr(names_at);
        const std::vector<Cell> above = split(names, separator_of(trimmed(names)));
        if (above.size() != header.size())
            throw bad_input("the first row holds numbers: no line names the columns", "begin the file with a line such as: time [s],id,x [mm],y [mm],z [mm]",
                            {file_, line_, 1});
        header = above;
        for (Cell& cell : header) cell.column += static_cast<int>(names_at);
        header_line_ = remark_line;
        at_ = line_begin;
        --line_;
    }
    if (header.size() > 1 && header.back().text.empty()) header.pop_back();  // a separator at the end of the line
    for (const Cell& cell : header) columns_.push_back(column_of(cell.text, cell.column));
}

bool Table::next_line(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    return true;
}

std::vector<Table::Cell> Table::split(std::string_view line, char separator) const {
    std::vector<Cell> cells;
    const auto add = [&](std::size_t begin, std::size_t end) {
        const std::string_view raw = line.substr(begin, end - begin);
        std::string_view text = trimmed(raw);
        const auto column = static_cast<int>((text.empty() ? raw.data() : text.data()) - line.data()) + 1;
        if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = trimmed(text.substr(1, text.size() - 2));
        // «x [mm]» between blanks is one cell.
        if (separator == ' ' && !cells.empty() && !text.empty() && (text.front() == '[' || text.front() == '('))
            cells.back().text = std::string_view(cells.back().text.data(), static_cast<std::size_t>(text.data() + text.size() - cells.back().text.data()));
        else
            cells.push_back({text, column});
    };
    if (separator == ' ') {
        std::size_t at = line.find_first_not_of(blanks);
        while (at != std::string_view::npos) {
            const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
            add(at, end);
            at = line.find_first_not_of(blanks, end);
        }
        return cells;
    }
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = std::min(line.find(separator, begin), line.size());
        add(begin, end);
        if (end == line.size()) return cells;
        begin = end + 1;
    }
}

bool Table::next() {
    std::string_view line;
    while (next_line(line)) {
        const std::string_view content = trimmed(line);
        if (content.empty() || is_remark(content)) continue;
        cells_ = split(line, separator_);
        if (cells_.size() == columns_.size() + 1 && cells_.back().text.empty()) cells_.pop_back();  // a separator at the end of the line
        if (cells_.size() != columns_.size())
            throw bad_input("this row has " + std::to_string(cells_.size()) + " cells and the header " + std::to_string(columns_.size()),
                            "give every row one cell a column (an empty one where nothing was measured)", {file_, line_, 1});
        return true;
    }
    return false;
}

double Table::number(std::size_t column) const {
    const std::string_view text = cells_[column].text;
    double value = std::numeric_limits<double>::quiet_NaN();
    if (parse_number(text, separator_ != ',', value)) return value;
    if (stands_for_nothing(text)) return std::numeric_limits<double>::quiet_NaN();
    throw bad_input("'" + std::string(text) + "' in the column '" + columns_[column].text + "' is no number",
                    "write a number, or nothing where none was measured", place(column));
}

Place Table::place(std::size_t column) const {
    return {file_, line_, cells_[column].column};
}

}  // namespace pelletlab::io::detail
