#include "io/measured_fills.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "core/error.hpp"
#include "core/units.hpp"
#include "io/csv_table.hpp"
#include "io/detail/table.hpp"

namespace pelletlab::io {

namespace {

using detail::Table;
constexpr std::size_t none = static_cast<std::size_t>(-1);

std::size_t column_of(const Table& table, std::initializer_list<const char*> names) {
    std::size_t found = none;
    for (std::size_t c = 0; c < table.columns().size(); ++c)
        for (const char* name : names)
            if (table.columns()[c].name == name) {
                if (found != none)
                    throw bad_input("the columns '" + table.columns()[found].text + "' and '" + table.columns()[c].text + "' mean the same", "remove one",
                                    table.header_place(c));
                found = c;
            }
    return found;
}

double factor_of(const Table& table, std::size_t column, Dimension dimension, const std::string& fallback) {
    const std::string unit = table.columns()[column].unit.empty() ? fallback : table.columns()[column].unit;
    if (unit.empty())
        throw bad_input("the column '" + table.columns()[column].text + "' has no unit",
                        "write it in the head: " + table.columns()[column].name + " [" + usual_units(dimension)[0] + "]", table.header_place(column));
    try {
        return unit_factor(unit, dimension);
    } catch (const Error& error) {
        throw bad_input(error.problem(), error.remedy(), table.header_place(column));
    }
}

double positive(const Table& table, std::size_t column, double factor) {
    const double value = table.number(column);
    if (!(value > 0.0))
        throw bad_input("'" + std::string(table.cell(column)) + "' under '" + table.columns()[column].text + "' is no number above 0", "correct it",
                        table.place(column));
    return value * factor;
}

struct Rows {
    double pellets, mass;
    int line;
    std::vector<double> heights;
};

MeasuredFill fill_of(const Rows& rows) {
    MeasuredFill fill{rows.pellets, rows.mass, 0.0, std::numeric_limits<double>::quiet_NaN(), static_cast<int>(rows.heights.size()), rows.line};
    for (const double h : rows.heights) fill.height += h / static_cast<double>(rows.heights.size());
    if (rows.heights.size() > 1) {
        double sum = 0.0;
        for (const double h : rows.heights) sum += (h - fill.height) * (h - fill.height);
        fill.deviation = std::sqrt(sum / static_cast<double>(rows.heights.size() - 1));
    }
    return fill;
}

}  // namespace

std::vector<MeasuredFill> parse_measured_fills(const std::string& text, const std::string& file, const std::string& length_unit) {
    Table table(text, file);
    const std::size_t pellets = column_of(table, {"pellets", "number", "count", "pellet_count"});
    const std::size_t mass = column_of(table, {"mass", "fill_mass", "weight"});
    const std::size_t height = column_of(table, {"height", "bed_height"});
    const std::size_t mean = column_of(table, {"mean", "height_mean", "mean_height"});
    const std::size_t deviation = column_of(table, {"sd", "deviation", "height_sd", "standard_deviation"});
    const std::size_t repeats = column_of(table, {"n", "repeats"});
    if (pellets == none && mass == none) throw bad_input("no column says how much was filled in", "name one «pellets» or «mass [g]»", table.header_place(0));
    if (height == none && mean == none) throw bad_input("no column holds the bed's height", "name one «height [mm]», or «mean [mm]»", table.header_place(0));
    if (height != none && mean != none) throw bad_input("single heights and their mean in one table", "keep one of the two columns", table.header_place(mean));
    if (mean != none && (deviation == none) != (repeats == none))
        throw bad_input("a standard deviation goes with the number of repeats", "give both columns, «sd [mm]» and «n», or none", table.header_place(mean));
    const double length = factor_of(table, height != none ? height : mean, dimension::length, length_unit);
    const double spread = deviation == none ? 0.0 : factor_of(table, deviation, dimension::length, length_unit);
    const double grams = mass == none ? 0.0 : factor_of(table, mass, dimension::mass, {});
    std::vector<Rows> singles;
    std::vector<MeasuredFill> fills;
    while (table.next()) {
        const double n = pellets == none ? 0.0 : positive(table, pellets, 1.0), m = mass == none ? 0.0 : positive(table, mass, grams);
        const int line = table.place(0).line;
        if (mean != none) {
            MeasuredFill fill{n, m, positive(table, mean, length), std::numeric_limits<double>::quiet_NaN(), 1, line};
            if (repeats != none) {
                fill.repeats = static_cast<int>(positive(table, repeats, 1.0));
                if (fill.repeats > 1) fill.deviation = table.number(deviation) * spread;
                if (fill.repeats > 1 && !(fill.deviation >= 0.0))
                    throw bad_input("no standard deviation of " + std::to_string(fill.repeats) + " repeats", "fill in the cell", table.place(deviation));
            }
            fills.push_back(fill);
            continue;
        }
        const auto same = std::find_if(singles.begin(), singles.end(), [&](const Rows& r) { return r.pellets == n && r.mass == m; });
        const double h = positive(table, height, length);
        if (same == singles.end())
            singles.push_back({n, m, line, {h}});
        else
            same->heights.push_back(h);
    }
    for (const Rows& rows : singles) fills.push_back(fill_of(rows));
    if (fills.empty()) throw bad_input("the table has a head and no row", "add the measured heights", {file});
    return fills;
}

std::vector<MeasuredFill> read_measured_fills(const std::filesystem::path& file, const std::string& length_unit) {
    return parse_measured_fills(read_text_or_gzip(file), file.string(), length_unit);
}

}  // namespace pelletlab::io
