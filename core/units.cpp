#include "core/units.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "core/error.hpp"

namespace pelletlab {

namespace {

struct UnitSymbol {
    const char* name;
    double factor;
    Dimension dimension;
};

constexpr double pi = std::numbers::pi;

constexpr std::array unit_symbols{
    UnitSymbol{"m", 1.0, dimension::length},       UnitSymbol{"dm", 1e-1, dimension::length},     UnitSymbol{"cm", 1e-2, dimension::length},
    UnitSymbol{"mm", 1e-3, dimension::length},     UnitSymbol{"um", 1e-6, dimension::length},     UnitSymbol{"µm", 1e-6, dimension::length},
    UnitSymbol{"nm", 1e-9, dimension::length},     UnitSymbol{"km", 1e3, dimension::length},      UnitSymbol{"in", 0.0254, dimension::length},
    UnitSymbol{"kg", 1.0, dimension::mass},        UnitSymbol{"g", 1e-3, dimension::mass},        UnitSymbol{"mg", 1e-6, dimension::mass},
    UnitSymbol{"t", 1e3, dimension::mass},         UnitSymbol{"s", 1.0, dimension::time},         UnitSymbol{"ms", 1e-3, dimension::time},
    UnitSymbol{"us", 1e-6, dimension::time},       UnitSymbol{"µs", 1e-6, dimension::time},       UnitSymbol{"min", 60.0, dimension::time},
    UnitSymbol{"h", 3600.0, dimension::time},      UnitSymbol{"rad", 1.0, dimension::angle},      UnitSymbol{"deg", pi / 180.0, dimension::angle},
    UnitSymbol{"°", pi / 180.0, dimension::angle}, UnitSymbol{"rev", 2.0 * pi, dimension::angle}, UnitSymbol{"rpm", 2.0 * pi / 60.0, dimension::rotation_speed},
    UnitSymbol{"Hz", 1.0, dimension::frequency},   UnitSymbol{"kHz", 1e3, dimension::frequency},  UnitSymbol{"N", 1.0, dimension::force},
    UnitSymbol{"mN", 1e-3, dimension::force},      UnitSymbol{"kN", 1e3, dimension::force},       UnitSymbol{"Pa", 1.0, dimension::pressure},
    UnitSymbol{"kPa", 1e3, dimension::pressure},   UnitSymbol{"MPa", 1e6, dimension::pressure},   UnitSymbol{"GPa", 1e9, dimension::pressure},
    UnitSymbol{"bar", 1e5, dimension::pressure},   UnitSymbol{"J", 1.0, dimension::energy},       UnitSymbol{"mJ", 1e-3, dimension::energy},
    UnitSymbol{"W", 1.0, Dimension{2, 1, -3, 0}},  UnitSymbol{"%", 1e-2, dimension::none},        UnitSymbol{"1", 1.0, dimension::none},
};

struct NamedDimension {
    const char* name;
    Dimension dimension;
    std::array<const char*, 3> units;  // preferred first, unused ones null
};

constexpr std::array named_dimensions{
    NamedDimension{"plain number", dimension::none, {"1", "%", nullptr}},
    NamedDimension{"length", dimension::length, {"mm", "m", "um"}},
    NamedDimension{"mass", dimension::mass, {"g", "kg", "mg"}},
    NamedDimension{"time", dimension::time, {"s", "ms", "us"}},
    NamedDimension{"angle", dimension::angle, {"deg", "rad", nullptr}},
    NamedDimension{"density", dimension::density, {"kg/m^3", "g/cm^3", nullptr}},
    NamedDimension{"pressure", dimension::pressure, {"MPa", "Pa", "GPa"}},
    NamedDimension{"velocity", dimension::velocity, {"m/s", "mm/s", nullptr}},
    NamedDimension{"acceleration", dimension::acceleration, {"m/s^2", nullptr, nullptr}},
    NamedDimension{"rotation speed", dimension::rotation_speed, {"rpm", "rad/s", "deg/s"}},
    NamedDimension{"force", dimension::force, {"N", "mN", nullptr}},
    NamedDimension{"energy", dimension::energy, {"J", "mJ", nullptr}},
    NamedDimension{"surface energy", dimension::surface_energy, {"J/m^2", "N/m", nullptr}},
    NamedDimension{"frequency", dimension::frequency, {"Hz", nullptr, nullptr}},
};

struct ParsedUnit {
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
        if (at == text.size()) throw bad_input("the unit '" + std::string(text) + "' ends too early");
    }
    return unit;
}

/// number · factor; small factors such as 1e-3 have an exact inverse, and dividing by it gives 0.00312 for 3.12 mm to the last bit.
double scaled(double number, double factor) {
    const double inverse = std::round(1.0 / factor);
    const bool has_whole_inverse = factor < 1.0 && std::abs(inverse * factor - 1.0) < 1e-15;
    return has_whole_inverse ? number / inverse : number * factor;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

}  // namespace

double unit_factor(std::string_view unit_text, Dimension expected) {
    const std::string_view text = trimmed(unit_text);
    if (text.empty()) throw bad_input("a unit is missing", "units of this quantity: " + list_of_units(expected));
    const ParsedUnit unit = parse_unit(text, expected);
    if (unit.dimension != expected)
        throw bad_input("'" + std::string(text) + "' is a unit of " + dimension_name(unit.dimension) + ", and a " + dimension_name(expected) + " is asked for",
                        "units of this quantity: " + list_of_units(expected));
    return unit.factor;
}

double parse_quantity(std::string_view whole_text, Dimension expected) {
    const std::string text(trimmed(whole_text));
    char* rest = nullptr;
    const double number = std::strtod(text.c_str(), &rest);
    if (rest == text.c_str())
        throw bad_input("'" + text + "' does not begin with a number", "write a number and a unit, for instance \"1.5 " + usual_units(expected)[0] + "\"");
    if (!std::isfinite(number)) throw bad_input("'" + text + "' is not a finite number");
    const std::string_view unit = trimmed(rest);
    if (unit.empty()) {
        if (expected == dimension::none) return number;
        throw bad_input("'" + text + "' has no unit", "units of this quantity (" + dimension_name(expected) + "): " + list_of_units(expected));
    }
    return scaled(number, unit_factor(unit, expected));
}

std::string format_quantity(double si_value, std::string_view unit_text) {
    const ParsedUnit unit = parse_unit(trimmed(unit_text), {});
    char buffer[40];
    const auto print_shortest = [&buffer](double number, const auto& reads_back) {
        for (int digits = 6; digits <= 17; ++digits) {
            std::snprintf(buffer, sizeof buffer, "%.*g", digits, number);
            if (reads_back(std::strtod(buffer, nullptr))) return true;
        }
        return false;
    };
    const std::string suffix = unit_text.empty() ? "" : " " + std::string(unit_text);
    if (print_shortest(si_value / unit.factor, [&](double number) { return scaled(number, unit.factor) == si_value; })) return buffer + suffix;
    print_shortest(si_value, [&](double number) { return number == si_value; });
    return buffer + (unit_text.empty() ? "" : " " + si_unit(unit.dimension));
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
