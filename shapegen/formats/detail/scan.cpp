#include "shapegen/formats/detail/scan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace pelletlab::shapegen::formats::detail {

std::vector<Line> lines_of(const FormatFile& file) {
    std::vector<Line> lines;
    const std::string_view text = file.content;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string_view line = text.substr(at, end - at);
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        lines.push_back({line, static_cast<int>(lines.size()) + 1});
        at = end + 1;
    }
    return lines;
}

std::vector<Token> split(const Line& line, std::string_view separators, bool keep_empty) {
    std::vector<Token> tokens;
    std::size_t at = 0;
    while (at <= line.text.size()) {
        const std::size_t end = std::min(line.text.find_first_of(separators, at), line.text.size());
        if (keep_empty || end > at) tokens.push_back({line.text.substr(at, end - at), line.number, static_cast<int>(at) + 1});
        at = end + 1;
    }
    return tokens;
}

Line without_comment(Line line, std::string_view comment_characters) {
    const std::size_t comment = line.text.find_first_of(comment_characters);
    if (comment != std::string_view::npos) line.text = line.text.substr(0, comment);
    return line;
}

Token trimmed(Token token) {
    constexpr std::string_view blanks = " \t\r\f\v";
    const std::size_t first = token.text.find_first_not_of(blanks);
    if (first == std::string_view::npos) {
        token.text = {};
        return token;
    }
    const std::size_t last = token.text.find_last_not_of(blanks);
    token.column += static_cast<int>(first);
    token.text = token.text.substr(first, last - first + 1);
    return token;
}

Place place_of(const FormatFile& file, const Token& token) {
    return {file.name, token.line, token.column};
}

std::string quoted(std::string_view text) {
    std::string shown = "'";
    for (const char c : text.substr(0, 40)) shown += (c >= ' ' && c <= '~') ? c : '?';
    if (text.size() > 40) shown += "…";
    return shown + "'";
}

std::optional<double> parse_number(std::string_view text) {
    if (!text.empty() && text.front() == '+') {
        text.remove_prefix(1);
        if (!text.empty() && text.front() == '-') return std::nullopt;
    }
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status == std::errc::result_out_of_range && end == text.data() + text.size()) {
        // Too small for a double is zero; too large is not a number that anything can use.
        const std::size_t exponent = text.find_first_of("eE");
        if (exponent != std::string_view::npos && exponent + 1 < text.size() && text[exponent + 1] == '-') return 0.0;
        return std::nullopt;
    }
    if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

double number(const FormatFile& file, const Token& token, std::string_view meaning) {
    const Token bare = trimmed(token);
    if (const std::optional<double> value = parse_number(bare.text)) return *value;
    throw bad_input(std::string(meaning) + " is not a finite number: " + quoted(bare.text), "write it like 0.00156 or 1.56e-3", place_of(file, bare));
}

double positive_number(const FormatFile& file, const Token& token, std::string_view meaning) {
    const double value = number(file, token, meaning);
    if (!(value > 0.0))
        throw bad_input(std::string(meaning) + " must be greater than zero, not " + quoted(trimmed(token).text), {}, place_of(file, trimmed(token)));
    return value;
}

long integer(const FormatFile& file, const Token& token, std::string_view meaning, long lowest, long highest) {
    const Token bare = trimmed(token);
    long value = 0;
    const auto [end, status] = std::from_chars(bare.text.data(), bare.text.data() + bare.text.size(), value);
    if (status != std::errc() || end != bare.text.data() + bare.text.size() || value < lowest || value > highest)
        throw bad_input(
            std::string(meaning) + " must be a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest) + ", not " + quoted(bare.text),
            {}, place_of(file, bare));
    return value;
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) { return (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c; });
    return lower;
}

Sphere sphere(const FormatFile& file, const Token& x, const Token& y, const Token& z, const Token& r, double length_unit) {
    Sphere s;
    s.centre = Vec3(number(file, x, "the x coordinate"), number(file, y, "the y coordinate"), number(file, z, "the z coordinate")) * length_unit;
    s.radius = positive_number(file, r, "the radius") * length_unit;
    if (!s.centre.allFinite() || !std::isfinite(s.radius) || !(s.radius > 0.0))
        throw bad_input("this sphere is too large or too small to compute with", "check the unit of the file", place_of(file, trimmed(x)));
    return s;
}

void check_count(const FormatFile& file, const std::vector<Sphere>& spheres) {
    if (spheres.empty()) throw bad_input("no spheres in this file", "is it the right file, and of the right format?", {file.name});
    if (spheres.size() > most_spheres) throw bad_input("more than " + std::to_string(most_spheres) + " spheres: this is not a clump", {}, {file.name});
}

}  // namespace pelletlab::shapegen::formats::detail
