#include "core/units.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "core/error.hpp"

namespace pelletlab {

namespace {

/// One unit is factor · 10^decimal in SI. Powers of ten are kept apart so that «3.12 mm» becomes the double nearest to 0.00312: they shift the
/// decimal point of the text instead of multiplying the number.
struct UnitSymbol {
    const char* name;
    int decimal;
    double factor;
    Dimension dimension;
};

constexpr double pi = std::numbers::pi;

constexpr std::array unit_symbols{
    UnitSymbol{"m", 0, 1.0, dimension::length},         UnitSymbol{"dm", -1, 1.0, dimension::length},
    UnitSymbol{"cm", -2, 1.0, dimension::length},       UnitSymbol{"mm", -3, 1.0, dimension::length},
    UnitSymbol{"um", -6, 1.0, dimension::length},       UnitSymbol{"µm", -6, 1.0, dimension::length},
    UnitSymbol{"nm", -9, 1.0, dimension::length},       UnitSymbol{"km", 3, 1.0, dimension::length},
    UnitSymbol{"in", -4, 254.0, dimension::length},     UnitSymbol{"kg", 0, 1.0, dimension::mass},
    UnitSymbol{"g", -3, 1.0, dimension::mass},          UnitSymbol{"mg", -6, 1.0, dimension::mass},
    UnitSymbol{"t", 3, 1.0, dimension::mass},           UnitSymbol{"s", 0, 1.0, dimension::time},
    UnitSymbol{"ms", -3, 1.0, dimension::time},         UnitSymbol{"us", -6, 1.0, dimension::time},
    UnitSymbol{"µs", -6, 1.0, dimension::time},         UnitSymbol{"min", 0, 60.0, dimension::time},
    UnitSymbol{"h", 0, 3600.0, dimension::time},        UnitSymbol{"rad", 0, 1.0, dimension::angle},
    UnitSymbol{"deg", 0, pi / 180.0, dimension::angle}, UnitSymbol{"°", 0, pi / 180.0, dimension::angle},
    UnitSymbol{"rev", 0, 2.0 * pi, dimension::angle},   UnitSymbol{"rpm", 0, 2.0 * pi / 60.0, dimension::rotation_speed},
    UnitSymbol{"Hz", 0, 1.0, dimension::frequency},     UnitSymbol{"kHz", 3, 1.0, dimension::frequency},
    UnitSymbol{"N", 0, 1.0, dimension::force},          UnitSymbol{"mN", -3, 1.0, dimension::force},
    UnitSymbol{"kN", 3, 1.0, dimension::force},         UnitSymbol{"Pa", 0, 1.0, dimension::pressure},
    UnitSymbol{"kPa", 3, 1.0, dimension::pressure},     UnitSymbol{"MPa", 6, 1.0, dimension::pressure},
    UnitSymbol{"GPa", 9, 1.0, dimension::pressure},     UnitSymbol{"bar", 5, 1.0, dimension::pressure},
    UnitSymbol{"J", 0, 1.0, dimension::energy},         UnitSymbol{"mJ", -3, 1.0, dimension::energy},
    UnitSymbol{"W", 0, 1.0, Dimension{2, 1, -3, 0}},    UnitSymbol{"%", -2, 1.0, dimension::none},
    UnitSymbol{"1", 0, 1.0, dimension::none},
};

struct NamedDimension {
    const char* name;
    Dimension dimension;
    std::array<const char*, 3> units;  // preferred first, unused ones null
};

constexpr std::array named_dimensions{
    NamedDimension{"plain number", dimension::none, {"1", "%", nullptr}},
    NamedDimension{"length", dimension::length, {"mm", "m", "um"}},
    NamedDimension{"area", dimension::area, {"mm^2", "m^2", nullptr}},
    NamedDimension{"volume", dimension::volume, {"mm^3", "m^3", nullptr}},
    NamedDimension{"mass", dimension::mass, {"g", "kg", "mg"}},
    NamedDimension{"time", dimension::time, {"s", "ms", "us"}},
    NamedDimension{"angle", dimension::angle, {"deg", "rad", nullptr}},
    NamedDimension{"moment of inertia", dimension::moment_of_inertia, {"g*mm^2", "kg*m^2", nullptr}},
    NamedDimension{"density", dimension::density, {"kg/m^3", "g/cm^3", nullptr}},
    NamedDimension{"pressure", dimension::pressure, {"MPa", "Pa", "GPa"}},
    NamedDimension{"velocity", dimension::velocity, {"m/s", "mm/s", nullptr}},
    NamedDimension{"acceleration", dimension::acceleration, {"m/s^2", nullptr, nullptr}},
    NamedDimension{"rotation speed", dimension::rotation_speed, {"rpm", "rad/s", "deg/s"}},
    NamedDimension{"force", dimension::force, {"N", "mN", nullptr}},
    NamedDimension{"energy", dimension::energy, {"J", "mJ", nullptr}},
    NamedDimension{"surface energy", dimension::surface_energy, {"J/m^2", "N/m", nullptr}},
    NamedDimension{"frequency", dimension::frequency, {"Hz", nullptr, nullptr}},
    NamedDimension{"viscosity", dimension::viscosity, {"Pa*s", nullptr, nullptr}},
};

struct ParsedUnit {
    int decimal = 0;
    double factor = 1.0;
    Dimension dimension;
};

std::string list_of_units(Dimension dimension) {
    std::string list;
    for (const std::string& unit : usual_units(dimension)) list += (list.empty() ? "" : ", ") + unit;
    return list;
}

std::optional<UnitSymbol> find_symbol(std::string_view name) {
    for (const UnitSymbol& symbol : unit_symbols)
        if (name == symbol.name) return symbol;
    return std::nullopt;
}

[[noreturn]] void throw_unknown_unit(std::string_view symbol, Dimension expected) {
    std::vector<std::string> names;
    for (const UnitSymbol& known : unit_symbols) names.emplace_back(known.name);
    const std::string guess = closest_word(std::string(symbol), names);
    throw bad_input("unknown unit '" + std::string(symbol) + "'",
                    (guess.empty() ? std::string() : "did you mean '" + guess + "'? ") + "units of this quantity: " + list_of_units(expected));
}

void multiply(ParsedUnit& unit, const UnitSymbol& symbol, int exponent) {
    unit.decimal += exponent * symbol.decimal;
    unit.factor *= std::pow(symbol.factor, exponent);
    unit.dimension.metre += exponent * symbol.dimension.metre;
    unit.dimension.kilogram += exponent * symbol.dimension.kilogram;
    unit.dimension.second += exponent * symbol.dimension.second;
    unit.dimension.radian += exponent * symbol.dimension.radian;
}

/// unit := symbol[^exponent] (('*' | '/' | ' ') symbol[^exponent])*; after '/' the exponent of the next symbol is negative.
ParsedUnit parse_unit(std::string_view text, Dimension expected) {
    ParsedUnit unit;
    std::size_t at = 0;
    int sign = 1;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find_first_of("*/ ^", at), text.size());
        const std::string_view name = text.substr(at, end - at);
        const auto symbol = find_symbol(name);
        if (!symbol) throw_unknown_unit(name, expected);
        at = end;
        int exponent = 1;
        if (at < text.size() && text[at] == '^') {
            const char* first = text.data() + at + 1;
            const auto [rest, status] = std::from_chars(first, text.data() + text.size(), exponent);
            if (status != std::errc() || std::abs(exponent) > 9)
                throw bad_input("the unit '" + std::string(text) + "' has a '^' without a small whole number after it", "write for instance m/s^2");
            at = static_cast<std::size_t>(rest - text.data());
        }
        multiply(unit, *symbol, sign * exponent);
        if (at == text.size()) break;
        sign = text[at] == '/' ? -1 : 1;
        ++at;
        if (at == text.size()) throw bad_input("the unit '" + std::string(text) + "' ends too early", "units of this quantity: " + list_of_units(expected));
    }
    return unit;
}

/// 10^exponent · number, the number given as text: the decimal exponent is rewritten, so the result is rounded once.
/// The text is one that from_chars has accepted; empty when the result is too large for a double, 0 when too small.
std::optional<double> shifted(std::string_view number, int exponent) {
    const std::size_t e = std::min(number.find_first_of("eE"), number.size());
    int written = 0;
    if (e < number.size()) {
        const char* first = number.data() + e + 1;
        if (*first == '+') ++first;
        std::from_chars(first, number.data() + number.size(), written);  // cannot overflow: the whole text was a finite number
    }
    const std::string text = std::string(number.substr(0, e)) + "e" + std::to_string(written + exponent);
    double value = 0.0;
    const auto [rest, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status == std::errc()) return value;
    return std::strtod(text.c_str(), nullptr) == 0.0 ? std::optional(0.0) : std::nullopt;
}

std::string exponent_text(int exponent) {
    return exponent == 0 ? std::string() : "e" + std::to_string(exponent);
}

/// Shortest decimal text that reads back to `value`, its decimal point moved so that it stands for value / 10^decimal.
std::string shortest_text(double value, int decimal) {
    if (!std::isfinite(value)) return std::isnan(value) ? "nan" : (value > 0.0 ? "inf" : "-inf");
    char buffer[40];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
    std::string_view text(buffer, static_cast<std::size_t>(end - buffer));
    const std::string sign = text.front() == '-' ? "-" : "";
    text.remove_prefix(sign.size());
    const std::size_t e = text.find('e');
    int exponent = 0;
    const char* first = text.data() + e + 1;
    std::from_chars(*first == '+' ? first + 1 : first, text.data() + text.size(), exponent);
    std::string digits;
    for (const char c : text.substr(0, e))
        if (c != '.') digits += c;
    exponent -= decimal;
    if (value == 0.0) return sign + "0";
    const int count = static_cast<int>(digits.size());
    if (exponent < -4 || exponent > 6) return sign + digits.substr(0, 1) + (count > 1 ? "." + digits.substr(1) : "") + exponent_text(exponent);
    if (exponent < 0) return sign + "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
    if (count <= exponent + 1) return sign + digits + std::string(static_cast<std::size_t>(exponent + 1 - count), '0');
    return sign + digits.substr(0, static_cast<std::size_t>(exponent) + 1) + "." + digits.substr(static_cast<std::size_t>(exponent) + 1);
}

double power_of_ten_times(double number, int decimal) {
    return decimal < 0 ? number / std::pow(10.0, -decimal) : number * std::pow(10.0, decimal);
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

}  // namespace

namespace {

ParsedUnit checked_unit(std::string_view unit_text, Dimension expected) {
    const std::string_view text = trimmed(unit_text);
    if (text.empty()) throw bad_input("a unit is missing", "units of this quantity: " + list_of_units(expected));
    const ParsedUnit unit = parse_unit(text, expected);
    if (unit.dimension != expected)
        throw bad_input("'" + std::string(text) + "' is a unit of " + dimension_name(unit.dimension) + ", and a " + dimension_name(expected) + " is asked for",
                        "units of this quantity: " + list_of_units(expected));
    return unit;
}

}  // namespace

double unit_factor(std::string_view unit_text, Dimension expected) {
    const ParsedUnit unit = checked_unit(unit_text, expected);
    return power_of_ten_times(unit.factor, unit.decimal);
}

Dimension unit_dimension(std::string_view unit) {
    const std::string_view text = trimmed(unit);
    if (text.empty()) throw bad_input("a unit is missing", "write \"1\" for a plain number");
    return parse_unit(text, dimension::none).dimension;
}

double parse_quantity(std::string_view whole_text, Dimension expected) {
    const std::string text(trimmed(whole_text));
    const char* const first = text.c_str() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0);
    const char* const last = text.c_str() + text.size();
    double number = 0.0;
    const auto [rest, status] = std::from_chars(first, last, number);
    if (rest == first)
        throw bad_input("'" + text + "' does not begin with a number", "write a number and a unit, for instance \"1.5 " + usual_units(expected)[0] + "\"");
    if (status != std::errc() || !std::isfinite(number)) throw bad_input("'" + text + "' is not a finite number", "write a number between 1e-300 and 1e300");
    const std::string_view unit_text = trimmed(std::string_view(rest, static_cast<std::size_t>(last - rest)));
    if (unit_text.empty()) {
        if (expected == dimension::none) return number;
        throw bad_input("'" + text + "' has no unit", "units of this quantity (" + dimension_name(expected) + "): " + list_of_units(expected));
    }
    const ParsedUnit unit = checked_unit(unit_text, expected);
    const auto decimal_number = shifted({first, static_cast<std::size_t>(rest - first)}, unit.decimal);
    if (!decimal_number || !std::isfinite(*decimal_number * unit.factor))
        throw bad_input("'" + text + "' is not a finite number in SI units", "write a smaller number");
    return *decimal_number * unit.factor;
}

std::string format_quantity(double value_in_si, std::string_view unit_text) {
    const ParsedUnit unit = parse_unit(trimmed(unit_text), {});
    const std::string suffix = unit_text.empty() ? "" : " " + std::string(unit_text);
    if (unit.factor == 1.0) {
        const std::string text = shortest_text(value_in_si, unit.decimal);
        double ignored = 0.0;
        if (std::from_chars(text.data(), text.data() + text.size(), ignored).ec == std::errc()) return text + suffix;  // else outside the range of a double
    }
    const double number = power_of_ten_times(value_in_si / unit.factor, -unit.decimal);
    for (int digits = 6; digits <= 17 && std::isfinite(number); ++digits) {
        char buffer[40];
        const auto end = std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::general, digits).ptr;
        const auto back = shifted({buffer, static_cast<std::size_t>(end - buffer)}, unit.decimal);
        if (back && *back * unit.factor == value_in_si) return std::string(buffer, end) + suffix;
    }
    const std::string si = si_unit(unit.dimension);
    return shortest_text(value_in_si, 0) + (si.empty() ? "" : " " + si);
}

std::string si_unit(Dimension dimension) {
    std::string text;
    const auto append = [&text](const char* name, int exponent) {
        if (exponent == 0) return;
        if (!text.empty()) text += "*";
        text += name;
        if (exponent != 1) text += "^" + std::to_string(exponent);
    };
    append("kg", dimension.kilogram);
    append("m", dimension.metre);
    append("rad", dimension.radian);
    append("s", dimension.second);
    return text;
}

std::vector<std::string> usual_units(Dimension dimension) {
    for (const NamedDimension& named : named_dimensions) {
        if (!(named.dimension == dimension)) continue;
        std::vector<std::string> units;
        for (const char* unit : named.units)
            if (unit != nullptr) units.emplace_back(unit);
        return units;
    }
    return {si_unit(dimension)};
}

std::string dimension_name(Dimension dimension) {
    for (const NamedDimension& named : named_dimensions)
        if (named.dimension == dimension) return named.name;
    return "quantity in " + si_unit(dimension);
}

}  // namespace pelletlab
