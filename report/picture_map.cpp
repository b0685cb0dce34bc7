#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "report/detail/bed_scene.hpp"
#include "report/detail/page.hpp"
#include "report/draw.hpp"

namespace pelletlab::report {
namespace {

constexpr double millimetre = 1e-3;

const FieldMap* find_map(const Observables& observables, const std::string& name) {
    for (const FieldMap& map : observables.maps)
        if (map.name == name) return &map;
    return nullptr;
}

const FieldMap& require_map(const Observables& observables, const std::string& name) {
    const FieldMap* map = find_map(observables, name);
    if (map == nullptr) {
        std::vector<std::string> names;
        for (const FieldMap& other : observables.maps) names.push_back(other.name);
        const std::string guess = closest_word(name, names);
        throw bad_input("the observables hold no map «" + name + "»", guess.empty() ? "" : "did you mean «" + guess + "»?");
    }
    if (map->columns == 0 || map->rows == 0 || map->value.size() != map->columns * map->rows || !(map->spacing > 0.0) || !std::isfinite(map->spacing))
        throw bad_input("the map «" + name + "» has no grid, or not one value a cell");
    return *map;
}

bool same_grid(const FieldMap& a, const FieldMap& b) {
    return a.columns == b.columns && a.rows == b.rows && a.spacing == b.spacing && a.origin_horizontal == b.origin_horizontal &&
           a.origin_vertical == b.origin_vertical && b.value.size() == b.columns * b.rows;
}

/// The plot's place on the page, and metres to pixels.
struct Plot {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
    double lower_a = 0.0, lower_b = 0.0;  // [m], of the lower left corner
    double scale = 1.0;                   // [pixel/m]
    double x(double a) const { return left + (a - lower_a) * scale; }
    double y(double b) const { return bottom - (b - lower_b) * scale; }
};

/// «distance_to_axis» → «distance to axis (mm)»
std::string axis_label(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name + " (mm)";
}

void draw_cells(Image& image, const FieldMap& map, const Plot& plot, ColourMap colours, const ValueRange& range) {
    for (std::size_t row = 0; row < map.rows; ++row)
        for (std::size_t column = 0; column < map.columns; ++column) {
            const double value = map.value[row * map.columns + column];
            if (!std::isfinite(value)) continue;
            const double a = map.origin_horizontal + map.spacing * static_cast<double>(column),
                         b = map.origin_vertical + map.spacing * static_cast<double>(row);
            const double half = 0.5 * map.spacing;
            // Whole pixels: neighbours meet without a seam.
            fill_rectangle(image, std::round(plot.x(a - half)), std::round(plot.y(b + half)), std::round(plot.x(a + half)), std::round(plot.y(b - half)),
                           map_srgb(colours, range.fraction(value)));
        }
}

void draw_axes(Image& image, const FieldMap& map, const Plot& plot, const detail::Page& page) {
    const double line = std::max(1.0, 1.3 * page.unit), tick = 7.0 * page.unit;
    fill_rectangle(image, plot.left - line, plot.bottom, plot.right, plot.bottom + line, page.small.colour);
    fill_rectangle(image, plot.left - line, plot.top, plot.left, plot.bottom + line, page.small.colour);
    TextStyle numbers = page.small;
    const double upper_a = plot.lower_a + (plot.right - plot.left) / plot.scale, upper_b = plot.lower_b + (plot.bottom - plot.top) / plot.scale;
    const Ticks along = nice_ticks(plot.lower_a / millimetre, upper_a / millimetre, 8), up = nice_ticks(plot.lower_b / millimetre, upper_b / millimetre, 8);
    numbers.align = Align::centre;
    for (const double value : along.values) {
        const double x = plot.x(value * millimetre);
        draw_line(image, {x, plot.bottom}, {x, plot.bottom + tick}, line, numbers.colour);
        draw_text(image, x, plot.bottom + tick + 1.8 * numbers.cap_height, tick_text(value, along.decimals), numbers);
    }
    numbers.align = Align::right;
    double widest = 0.0;
    for (const double value : up.values) {
        const double y = plot.y(value * millimetre);
        const std::string text = tick_text(value, up.decimals);
        widest = std::max(widest, text_width(text, numbers));
        draw_line(image, {plot.left - tick, y}, {plot.left, y}, line, numbers.colour);
        draw_text(image, plot.left - tick - 0.5 * numbers.cap_height, y + 0.5 * numbers.cap_height, text, numbers);
    }
    TextStyle names = page.text;
    names.align = Align::centre;
    draw_text(image, 0.5 * (plot.left + plot.right), plot.bottom + tick + 4.4 * names.cap_height, axis_label(map.horizontal_axis), names);
    names.upwards = true;
    draw_text(image, plot.left - tick - 1.5 * names.cap_height - widest, 0.5 * (plot.top + plot.bottom), axis_label(map.vertical_axis), names);
}

/// Mean velocity of blocks of cells, so that arrows stand at least `pitch` pixels apart.
struct ArrowField {
    std::vector<Point> at, velocity;  // [m], [unit of the maps]
    double spacing = 0.0;             // [m]
    double long_speed = 0.0;          // 98 % of the arrows are no longer
};

ArrowField arrows_of(const FieldMap& u, const FieldMap& w, double pixels_per_metre, double pitch) {
    const auto block = static_cast<std::size_t>(std::max(1.0, std::ceil(pitch / (u.spacing * pixels_per_metre) - 1e-9)));
    ArrowField field;
    field.spacing = u.spacing * static_cast<double>(block);
    std::vector<double> speeds;
    for (std::size_t row = 0; row < u.rows; row += block)
        for (std::size_t column = 0; column < u.columns; column += block) {
            double sum_u = 0.0, sum_w = 0.0, a = 0.0, b = 0.0, count = 0.0;
            for (std::size_t r = row; r < std::min(row + block, u.rows); ++r)
                for (std::size_t c = column; c < std::min(column + block, u.columns); ++c) {
                    const std::size_t cell = r * u.columns + c;
                    if (!std::isfinite(u.value[cell]) || !std::isfinite(w.value[cell])) continue;
                    sum_u += u.value[cell];
                    sum_w += w.value[cell];
                    a += u.origin_horizontal + u.spacing * static_cast<double>(c);
                    b += u.origin_vertical + u.spacing * static_cast<double>(r);
                    count += 1.0;
                }
            if (count < 0.5 * static_cast<double>(block * block)) continue;
            field.at.push_back({a / count, b / count});
            field.velocity.push_back({sum_u / count, sum_w / count});
            speeds.push_back(std::hypot(sum_u, sum_w) / count);
        }
    if (speeds.empty()) return field;
    std::sort(speeds.begin(), speeds.end());
    field.long_speed = speeds[static_cast<std::size_t>(0.98 * static_cast<double>(speeds.size() - 1))];
    return field;
}

/// Black or white, whichever stands out.
Srgb ink_on(const Srgb& paper) {
    const Colour light = linear_colour(paper);
    return 0.2126f * light[0] + 0.7152f * light[1] + 0.0722f * light[2] > 0.18f ? Srgb{20, 24, 30} : Srgb{250, 250, 250};
}

Srgb pixel_at(const Image& image, double x, double y) {
    const auto column = static_cast<std::size_t>(std::clamp(x, 0.0, image.width - 1.0)), row = static_cast<std::size_t>(std::clamp(y, 0.0, image.height - 1.0));
    const std::size_t at = 3 * (row * image.width + column);
    return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// Arrows and, in the lower right corner of the page, one of a round length with its number.
void draw_arrows(Image& image, const ArrowField& field, const Plot& plot, const detail::Page& page, const std::string& unit, double key_left,
                 double circle_radius) {
    if (!(field.long_speed > 0.0)) return;
    const double longest = 1.5 * field.spacing * plot.scale, width = std::max(1.0, 1.7 * page.unit);
    for (std::size_t i = 0; i < field.at.size(); ++i) {
        const double x = plot.x(field.at[i].x), y = plot.y(field.at[i].y), per = longest / field.long_speed;
        const double dx = 0.5 * per * field.velocity[i].x, dy = -0.5 * per * field.velocity[i].y;
        if (circle_radius > 0.0 && std::hypot(field.at[i].x, field.at[i].y) > circle_radius) continue;
        if (std::hypot(dx, dy) < 0.75) continue;  // shorter than a pixel and a half: at rest
        const Srgb ink = ink_on(pixel_at(image, x, y));
        const bool bright = ink[0] > 128;  // such an arrow may reach over the edge of the bed: a thin dark rim keeps it visible there
        draw_arrow(image, {x - dx, y - dy}, {x + dx, y + dy}, width, ink, bright ? 0.8 * page.unit : 0.0, {72, 78, 110});
    }
    const double shown = round_up(field.long_speed), length = longest * shown / field.long_speed;
    const double y = plot.bottom - 0.5 * page.text.cap_height;
    draw_arrow(image, {key_left, y}, {key_left + length, y}, 1.2 * width, page.text.colour);
    const Ticks decimals = nice_ticks(0.0, shown, 1);
    draw_text(image, key_left, y - 1.2 * page.text.cap_height, tick_text(shown, std::max(decimals.decimals, 0)) + " " + unit, page.text);
}

std::string label_of(const FieldMap& map) {
    std::string label = map.name;
    std::replace(label.begin(), label.end(), '_', ' ');
    return map.unit.empty() || map.unit == "1" ? label : label + " (" + map.unit + ")";
}

ColourBar bar_of(const FieldMap& map, const std::optional<ValueRange>& wanted) {
    ColourBar bar;
    bar.label = label_of(map);
    bar.range = wanted.value_or(detail::automatic_range(map.value, 0.995));
    if (bar.range.lower < 0.0 && !wanted) {
        const double end = std::max(-bar.range.lower, bar.range.upper);
        bar.range = {-end, end};
        bar.map = ColourMap::diverging;
    }
    for (const double value : map.value) {
        bar.some_below |= value < bar.range.lower;
        bar.some_above |= value > bar.range.upper;
    }
    return bar;
}

}  // namespace

Image picture_of_map(const Observables& observables, const std::string& map_name, const PictureSettings& settings) {
    const FieldMap& map = require_map(observables, map_name);
    const detail::Page page(settings.width);
    const ColourBar bar = bar_of(map, settings.range);

    Plot plot;
    const double cells_a = static_cast<double>(map.columns) * map.spacing, cells_b = static_cast<double>(map.rows) * map.spacing;
    const double extent_a = std::max(cells_a, settings.circle_diameter * 1.01), extent_b = std::max(cells_b, settings.circle_diameter * 1.01);
    plot.left = page.margin + 6.5 * page.text.cap_height;
    plot.right = settings.width - colour_bar_width(bar, page.bar_width, page.text) - 2.0 * page.margin;
    plot.scale = std::min((plot.right - plot.left) / extent_a, 1.5 * settings.width / extent_b);
    plot.right = plot.left + extent_a * plot.scale;
    plot.top = 2.2 * page.margin + page.title.cap_height;
    plot.bottom = plot.top + extent_b * plot.scale;
    plot.lower_a = map.origin_horizontal - 0.5 * map.spacing - 0.5 * (extent_a - cells_a);
    plot.lower_b = map.origin_vertical - 0.5 * map.spacing - 0.5 * (extent_b - cells_b);

    Image image = blank_image(settings.width, static_cast<std::uint32_t>(std::ceil(plot.bottom + 1.4 * page.margin + 4.4 * page.text.cap_height)));
    draw_cells(image, map, plot, bar.map, bar.range);
    if (settings.circle_diameter > 0.0) {
        const Point centre = {plot.x(0.0), plot.y(0.0)};
        const double radius = 0.5 * settings.circle_diameter * plot.scale;
        fill_outside_circle(image, plot.left, plot.top, plot.right, plot.bottom, centre, radius, {255, 255, 255});  // cells on the wall reach beyond it
        draw_circle(image, centre, radius, 2.0 * page.unit, page.text.colour);
    }
    const double bar_left = plot.right + page.margin, bar_height = std::min(0.55 * (plot.bottom - plot.top), 420.0 * page.unit);
    const FieldMap *u = find_map(observables, "vx"), *w = find_map(observables, "vz");
    if (u != nullptr && w != nullptr && map.unit == u->unit && same_grid(map, *u) && same_grid(map, *w))
        draw_arrows(image, arrows_of(*u, *w, plot.scale, 26.0 * page.unit), plot, page, map.unit, bar_left, 0.5 * settings.circle_diameter);
    draw_axes(image, map, plot, page);
    draw_colour_bar(image, bar, bar_left, plot.top + 0.5 * (plot.bottom - plot.top - bar_height), page.bar_width, bar_height, page.text);
    const std::string name = observables.case_name.empty() ? "" : observables.case_name + ": ";
    const std::string begin = tick_text(map.window.begin, 2), end = tick_text(map.window.end, 2);
    const std::string made = name + (map.window.begin < map.window.end ? "mean over " + begin + " – " + end + " s" : "at " + end + " s");
    draw_text(image, plot.left, page.margin + page.title.cap_height, settings.title.value_or(made), page.title);
    return image;
}

}  // namespace pelletlab::report
