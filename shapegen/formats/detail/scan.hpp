// Text in, numbers out: lines and tokens that remember their place, so that every error names file, line and column.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "shapegen/formats/formats.hpp"

namespace pelletlab::shapegen::formats::detail {

struct Token {
    std::string_view text;
    int line = 0;
    int column = 0;  ///< in bytes, from 1
};

struct Line {
    std::string_view text;  ///< without the line break
    int number = 0;
};

/// Lines of the file; the views stay valid as long as the file does. A final line break makes no empty line.
std::vector<Line> lines_of(const FormatFile& file);

/// Pieces of the line between separators. With `keep_empty` every separator counts (CSV), otherwise runs of them count once.
std::vector<Token> split(const Line& line, std::string_view separators, bool keep_empty = false);

/// The line up to the first comment character.
Line without_comment(Line line, std::string_view comment_characters);

/// The token without surrounding blanks; its column moves along.
Token trimmed(Token token);

Place place_of(const FormatFile& file, const Token& token);

/// The text as it may stand in a message: printable, at most 40 characters, in quotes.
std::string quoted(std::string_view text);

/// A finite number; `meaning` names it in the error («the radius»).
double number(const FormatFile& file, const Token& token, std::string_view meaning);
double positive_number(const FormatFile& file, const Token& token, std::string_view meaning);

/// An integer in [lowest, highest].
long integer(const FormatFile& file, const Token& token, std::string_view meaning, long lowest, long highest);

std::optional<double> parse_number(std::string_view text);

std::string lower_case(std::string_view text);

/// Sphere from four tokens x, y, z, r times the unit; the radius must be positive and everything finite after scaling.
Sphere sphere(const FormatFile& file, const Token& x, const Token& y, const Token& z, const Token& r, double length_unit);

/// At most this many spheres are read: more is not a clump but a mistake.
inline constexpr std::size_t most_spheres = 1'000'000;

/// Throws when the list is empty or too long.
void check_count(const FormatFile& file, const std::vector<Sphere>& spheres);

}  // namespace pelletlab::shapegen::formats::detail
