#include "io/csv_table.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string_view>

#include "io/files.hpp"

namespace pelletlab::io {

namespace {

constexpr std::size_t largest_table = std::size_t{1} << 29;  // bytes after inflating: more is no table of runs, or a file made to fill the memory

std::string trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '\r')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    return std::string(text);
}

std::vector<std::string> split(std::string_view line, char separator) {
    std::vector<std::string> fields;
    std::string field;
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') quoted = !quoted;
        if (c == separator && !quoted) {
            fields.push_back(trimmed(field));
            field.clear();
        } else {
            field += c;
        }
    }
    fields.push_back(trimmed(field));
    return fields;
}

char separator_of(std::string_view header) {
    char best = ',';
    std::size_t most = 0;
    for (const char c : {',', ';', '\t'}) {
        const std::size_t count = split(header, c).size();
        if (count > most) {
            most = count;
            best = c;
        }
    }
    return best;
}

}  // namespace

std::string read_text_or_gzip(const std::filesystem::path& file) {
    std::string raw = read_text(file);
    const bool compressed = raw.size() > 2 && static_cast<unsigned char>(raw[0]) == 0x1f && static_cast<unsigned char>(raw[1]) == 0x8b;
    if (!compressed) {
        if (file.extension() == ".gz") throw bad_input("the file ends in .gz and is no gzip file", "compress it again, or rename it", {file.string()});
        return raw;
    }
    const std::unique_ptr<gzFile_s, decltype(&gzclose)> stream(gzopen(file.c_str(), "rb"), gzclose);
    if (!stream) throw bad_input("the file cannot be read", "check the name and the permissions", {file.string()});
    std::string text;
    std::array<char, 1 << 16> buffer{};
    for (;;) {
        const int count = gzread(stream.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
        if (count < 0) throw bad_input("the gzip file is damaged", "compress or copy it again", {file.string()});
        if (count == 0) break;
        text.append(buffer.data(), static_cast<std::size_t>(count));
        if (text.size() > largest_table) throw bad_input("the table is larger than 512 MiB", "split the campaign", {file.string()});
    }
    int status = Z_OK;
    gzerror(stream.get(), &status);
    if (status != Z_OK || !gzeof(stream.get())) throw bad_input("the gzip file ends too early", "copy it again", {file.string()});
    return text;
}

CsvTable parse_csv(const std::string& text, const std::string& file) {
    CsvTable table;
    table.file = file;
    char separator = ',';
    int line_number = 0;
    std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line(text.data() + at, end - at);
        at = end + 1;
        ++line_number;
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string_view::npos || line[first] == '#') continue;
        if (table.columns.empty()) {
            separator = separator_of(line);
            table.columns = split(line, separator);
            table.header_line = line_number;
            std::set<std::string> seen;
            for (const std::string& name : table.columns)
                if (!seen.insert(name).second) throw bad_input("the column '" + name + "' is named twice", "rename one of them", {file, line_number});
            continue;
        }
        table.fields.push_back(split(line, separator));
        table.lines.push_back(line_number);
        if (table.fields.back().size() != table.columns.size())
            throw bad_input("the row has " + std::to_string(table.fields.back().size()) + " fields, and the header names " +
                                std::to_string(table.columns.size()) + " columns",
                            "give every row one field a column; an empty field means «not known»", {file, line_number});
    }
    if (table.columns.empty()) throw bad_input("the table is empty", "its first line must name the columns", {file});
    if (table.fields.empty()) throw bad_input("the table has a header and no rows", "add rows", {file, table.header_line});
    return table;
}

CsvTable read_csv(const std::filesystem::path& file) {
    return parse_csv(read_text_or_gzip(file), file.string());
}

bool CsvTable::has_column(const std::string& name) const {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
}

std::size_t CsvTable::column(const std::string& name) const {
    const auto found = std::find(columns.begin(), columns.end(), name);
    if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
    const std::string guess = closest_word(name, columns);
    std::string some;
    for (std::size_t i = 0; i < std::min<std::size_t>(8, columns.size()); ++i) some += (i == 0 ? "" : ", ") + columns[i];
    throw bad_input("there is no column '" + name + "'",
                    guess.empty() ? "columns of this table: " + some + (columns.size() > 8 ? ", …" : "") : "did you mean '" + guess + "'?",
                    {file, header_line});
}

Place CsvTable::place(std::size_t row, std::size_t column) const {
    std::size_t character = 1;
    for (std::size_t i = 0; i < column; ++i) character += fields[row][i].size() + 1;
    return {file, lines[row], static_cast<int>(character)};
}

double CsvTable::number(std::size_t row, std::size_t column) const {
    const std::string& field = fields[row][column];
    if (field.empty() || field == "nan" || field == "NaN" || field == "NA") return std::numeric_limits<double>::quiet_NaN();
    const char* first = field.data() + (field.front() == '+' ? 1 : 0);
    double value = 0.0;
    const auto [rest, status] = std::from_chars(first, field.data() + field.size(), value);
    if (status != std::errc() || rest != field.data() + field.size() || !std::isfinite(value))
        throw bad_input("'" + field + "' in column '" + columns[column] + "' is no number", "write a number with a decimal point, or leave the field empty",
                        place(row, column));
    return value;
}

}  // namespace pelletlab::io
