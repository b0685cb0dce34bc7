#include "observables/drum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>

#include "core/error.hpp"
#include "observables/detail/drum_fields.hpp"
#include "observables/detail/end_view.hpp"
#include "observables/detail/free_surface.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables {

namespace {

using detail::FreeSurface;
using detail::SurfaceFigures;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double millimetre = 1e-3;
constexpr std::size_t points_per_pellet = 125;
constexpr std::size_t most_groups = 20;
constexpr std::size_t surface_columns = 80;       // over the drum's diameter
constexpr double rows_per_pellet = 12.0;          // of the occupancy grid, over one equivalent diameter
constexpr double angle_tolerance = 1.0 * degree;  // a drift below this is steady whatever its error
constexpr double height_tolerance = 0.02;         // of the bed height

void require_usable(const FrameSource& trajectory, const DrumGeometry& drum) {
    if (!(drum.radius > 0.0) || !(drum.length > 0.0) || !(drum.velocity_grid > 0.0))
        throw bad_input("the drum to measure has no radius, length or velocity grid");
    if (drum.velocity_grid < drum.radius / 1000.0)
        throw bad_input("a velocity grid of " + std::to_string(drum.velocity_grid / millimetre) + " mm is too fine for this drum",
                        "choose measurement.velocity_grid of at least a thousandth of the drum's radius");
    if (trajectory.header().shape_of_body.empty()) throw bad_input("the trajectory holds no pellets", "run the case again");
}

std::vector<std::size_t> frames_in(const FrameSource& trajectory, const TimeWindow& window) {
    std::vector<std::size_t> frames;
    const double rounding = 1e-9 * std::max(1.0, std::abs(window.end));  // [s]; frame times are sums of time steps
    for (std::size_t k = 0; k < trajectory.frame_count(); ++k) {
        const double time = trajectory.time(k);
        if (time >= window.begin - rounding && time <= window.end + rounding) frames.push_back(k);
    }
    if (frames.empty())
        throw bad_input("the trajectory has no frame between " + std::to_string(window.begin) + " s and " + std::to_string(window.end) + " s",
                        "measure a window that the run covers");
    return frames;
}

/// Up to 20 groups of neighbouring frames, as equal as can be.
std::vector<std::vector<std::size_t>> grouped(const std::vector<std::size_t>& frames) {
    const std::size_t count = std::min(most_groups, frames.size());
    std::vector<std::vector<std::size_t>> groups(count);
    for (std::size_t g = 0; g < count; ++g)
        groups[g].assign(frames.begin() + static_cast<std::ptrdiff_t>(g * frames.size() / count),
                         frames.begin() + static_cast<std::ptrdiff_t>((g + 1) * frames.size() / count));
    return groups;
}

double mean_diameter(const TrajectoryHeader& header, const std::vector<detail::PelletPoints>& shapes) {
    double sum = 0.0;
    for (const std::uint32_t shape : header.shape_of_body) sum += shapes[shape].equivalent_diameter;
    return sum / static_cast<double>(header.shape_of_body.size());
}

detail::ChordFrame chord_frame(const detail::Vec2& centre_of_mass, double rotation_speed) {
    detail::ChordFrame chord;
    chord.mirror = rotation_speed < 0.0 ? -1.0 : 1.0;
    const double distance = std::hypot(centre_of_mass.a, centre_of_mass.b);
    if (distance > 0.0) {
        chord.out_x = -chord.mirror * centre_of_mass.a / distance;
        chord.out_z = -centre_of_mass.b / distance;
    }
    return chord;
}

/// One stretch of time: its sums, free surface and figures.
struct Stretch {
    detail::GroupSums sums;
    FreeSurface surface;
    SurfaceFigures figures;
    double bed_area = 0.0;  ///< [m²], of the end view below the surface
};

struct Analysis {
    const DrumGeometry& drum;
    detail::SurfaceSettings settings;
    detail::ChordFrame chord;
    detail::EndView view;
    double bulk = 0.0;  ///< packing fraction of the bed's inside
    Stretch whole;
    std::vector<Stretch> groups;
    TimeWindow window;

    /// Mean over the window with the standard error from the groups.
    Observable observable(const char* name, const char* unit, double scale, const char* method, const std::function<double(const Stretch&)>& figure) const {
        std::vector<double> series;
        for (const Stretch& group : groups) series.push_back(figure(group) / scale);
        return {name, unit, figure(whole) / scale, standard_error(series), window, method};
    }
};

Stretch stretch_of(detail::GroupSums sums, const Analysis& analysis) {
    Stretch stretch{std::move(sums), {}, {}, 0.0};
    const detail::ViewGrid& grid = analysis.view.chord_grid;
    const auto packing = detail::packing_field(grid, stretch.sums.chord.volume, static_cast<double>(stretch.sums.frames), analysis.settings);
    stretch.surface = detail::free_surface(grid, packing, 0.5 * analysis.bulk, analysis.settings);
    stretch.figures = detail::surface_figures(stretch.surface, analysis.chord);
    stretch.bed_area = detail::area_below(stretch.surface, grid, analysis.settings);
    return stretch;
}

detail::GroupSums sum_of(const std::vector<detail::GroupSums>& groups, std::size_t begin, std::size_t end, std::size_t cells) {
    detail::GroupSums sum{0, detail::CellSums(cells)};
    for (std::size_t g = begin; g < end; ++g) {
        sum.frames += groups[g].frames;
        sum.chord.add(groups[g].chord);
    }
    return sum;
}

/// What moved between the two halves of the window, against the larger of a tolerance and three errors of the difference (three
/// figures are tested, so two errors would call every seventh steady run unsteady).
std::string steadiness(const Analysis& analysis) {
    const std::size_t count = analysis.groups.size();
    if (count < 4) return "complete";  // too few frames to tell; the missing standard errors say so
    const std::size_t cells = analysis.view.chord_grid.cells();
    const Stretch early = stretch_of(sum_of(analysis.view.groups, 0, count / 2, cells), analysis);
    const Stretch late = stretch_of(sum_of(analysis.view.groups, count / 2, count, cells), analysis);
    const auto drifts = [&](const std::function<double(const Stretch&)>& figure, double tolerance) {
        std::vector<double> series;
        for (const Stretch& group : analysis.groups) series.push_back(figure(group));
        // Scatter about each half's own mean: a drift must not hide behind the error that it makes itself.
        const std::span<double> first_half(series.data(), count / 2), second_half(series.data() + count / 2, count - count / 2);
        for (const std::span<double> half : {first_half, second_half}) {
            const double mean = mean_of(half);
            for (double& value : half) value -= mean;
        }
        const double error_of_difference = 2.0 * standard_error(series);  // each half has √2 times the error of the whole
        const double allowed = std::isfinite(error_of_difference) ? std::max(tolerance, 3.0 * error_of_difference) : tolerance;
        return std::abs(figure(late) - figure(early)) > allowed;
    };
    const double bed_height = analysis.whole.figures.highest + analysis.drum.radius;
    const bool drifting = drifts([](const Stretch& s) { return s.figures.upper_angle; }, angle_tolerance) ||
                          drifts([](const Stretch& s) { return s.figures.lower_angle; }, angle_tolerance) ||
                          drifts([](const Stretch& s) { return s.figures.highest; }, height_tolerance * bed_height);
    return drifting ? "not steady" : "complete";
}

Profile surface_profile(const Analysis& analysis) {
    Profile profile{"free_surface", "mm", "x", "mm", {}, {}, {}, analysis.window, "drum.free_surface"};
    std::vector<double> x;
    const double step = 2.0 * analysis.drum.radius / static_cast<double>(surface_columns);
    for (std::size_t k = 0; k < surface_columns; ++k) x.push_back(-analysis.drum.radius + (static_cast<double>(k) + 0.5) * step);
    const std::vector<double> height = detail::surface_height(analysis.whole.surface, analysis.chord, x);
    std::vector<std::vector<double>> of_group;
    for (const Stretch& group : analysis.groups) of_group.push_back(detail::surface_height(group.surface, analysis.chord, x));
    for (std::size_t k = 0; k < surface_columns; ++k) {
        std::vector<double> series;
        for (const auto& heights : of_group) series.push_back(heights[k] / millimetre);
        profile.axis.push_back(x[k] / millimetre);
        profile.value.push_back(height[k] / millimetre);
        profile.standard_error.push_back(std::isfinite(height[k]) ? standard_error(series) : not_known);
    }
    return profile;
}

Profile chord_profile(const Analysis& analysis) {
    Profile profile{"free_surface_chord", "mm", "distance_along_chord", "mm", {}, {}, {}, analysis.window, "drum.free_surface"};
    for (std::size_t k = 0; k < analysis.whole.surface.xi.size(); ++k) {
        std::vector<double> series;
        for (const Stretch& group : analysis.groups) series.push_back(group.surface.eta[k] / millimetre);
        profile.axis.push_back(analysis.whole.surface.xi[k] / millimetre);
        profile.value.push_back(analysis.whole.surface.eta[k] / millimetre);
        profile.standard_error.push_back(std::isfinite(profile.value[k]) ? standard_error(series) : not_known);
    }
    return profile;
}

/// A profile that `of_stretch` computes for the window and for each group.
Profile with_errors(Profile profile, const Analysis& analysis, const std::function<std::vector<double>(const Stretch&)>& of_stretch) {
    profile.value = of_stretch(analysis.whole);
    std::vector<std::vector<double>> of_group;
    for (const Stretch& group : analysis.groups) of_group.push_back(of_stretch(group));
    for (std::size_t k = 0; k < profile.value.size(); ++k) {
        std::vector<double> series;
        for (const auto& values : of_group) series.push_back(values[k]);
        profile.standard_error.push_back(std::isfinite(profile.value[k]) ? standard_error(series) : not_known);
    }
    return profile;
}

std::vector<Profile> velocity_profiles(const Analysis& analysis) {
    const detail::ViewGrid& grid = analysis.view.chord_grid;
    const double diameter = analysis.settings.pellet_diameter;
    Profile along{"surface_velocity", "m/s", "distance_along_chord", "mm", {}, {}, {}, analysis.window, "drum.surface_velocity"};
    for (std::size_t c = 0; c < grid.columns; ++c) along.axis.push_back(grid.centre_a(c) / millimetre);
    Profile deep{"depth_velocity", "m/s", "depth", "mm", {}, {}, {}, analysis.window, "drum.depth_velocity"};
    const auto bins = static_cast<std::size_t>(std::ceil(analysis.drum.radius / (0.5 * diameter)));
    for (std::size_t k = 0; k < bins; ++k) deep.axis.push_back((static_cast<double>(k) + 0.5) * 0.5 * diameter / millimetre);
    return {
        with_errors(std::move(along), analysis, [&](const Stretch& s) { return detail::surface_velocity(s.sums.chord, s.surface, grid, diameter); }),
        with_errors(std::move(deep), analysis, [&](const Stretch& s) { return detail::depth_velocity(s.sums.chord, s.surface, grid, 0.5 * diameter, bins); })};
}

std::vector<Observable> scalars(const Analysis& analysis) {
    const DrumGeometry& drum = analysis.drum;
    const double drum_area = std::numbers::pi * drum.radius * drum.radius;
    std::vector<Observable> values;
    values.push_back(analysis.observable("upper_angle_of_repose", "deg", degree, "drum.angles", [](const Stretch& s) { return s.figures.upper_angle; }));
    values.push_back(analysis.observable("lower_angle_of_repose", "deg", degree, "drum.angles", [](const Stretch& s) { return s.figures.lower_angle; }));
    values.push_back(analysis.observable("dynamic_angle_of_repose", "deg", degree, "drum.angles", [](const Stretch& s) { return s.figures.whole_angle; }));
    values.push_back(analysis.observable("bed_height", "mm", millimetre, "drum.bed_height", [&](const Stretch& s) { return s.figures.highest + drum.radius; }));
    values.push_back(analysis.observable("fill_level", "1", 1.0, "drum.fill_level", [&](const Stretch& s) { return s.bed_area / drum_area; }));
    values.push_back(analysis.observable("bed_packing_fraction", "1", 1.0, "drum.bed_packing_fraction",
                                         [&](const Stretch& s) { return analysis.view.solid_volume / (s.bed_area * drum.length); }));
    values.push_back({"bulk_packing_fraction", "1", analysis.bulk, not_known, analysis.window, "drum.bulk_packing_fraction"});
    values.push_back({"centre_of_mass_angle", "deg", analysis.chord.inclination() / degree, not_known, analysis.window, "drum.centre_of_mass_angle"});
    values.push_back(analysis.observable("surface_velocity", "m/s", 1.0, "drum.surface_velocity", [&](const Stretch& s) {
        return detail::middle_surface_velocity(s.sums.chord, s.surface, analysis.view.chord_grid, analysis.settings.pellet_diameter);
    }));
    if (drum.rotation_speed != 0.0)
        values.push_back(analysis.observable("rigid_layer_rotation", "1", std::abs(drum.rotation_speed), "drum.rigid_layer_rotation", [&](const Stretch& s) {
            return detail::rigid_layer_rotation(s.sums.chord, s.surface, analysis.view.chord_grid, analysis.settings);
        }));
    return values;
}

}  // namespace

Observables measure_drum(const FrameSource& trajectory, const DrumGeometry& drum, const TimeWindow& window) {
    require_usable(trajectory, drum);
    const TrajectoryHeader& header = trajectory.header();
    const std::vector<std::size_t> frames = frames_in(trajectory, window);
    const std::vector<detail::PelletPoints> shapes = detail::sample_shapes(header, points_per_pellet);
    const double diameter = mean_diameter(header, shapes);

    const detail::ChordFrame chord = chord_frame(detail::mean_position(trajectory, frames, shapes), drum.rotation_speed);
    const auto rows = static_cast<std::size_t>(std::ceil(2.0 * drum.radius / diameter * rows_per_pellet));
    const auto map_side = static_cast<std::size_t>(std::ceil(2.0 * drum.radius / drum.velocity_grid));
    const detail::ViewGrid chord_grid = detail::ViewGrid::over(drum.radius, surface_columns, rows);
    const detail::ViewGrid map_grid = detail::ViewGrid::over(0.5 * static_cast<double>(map_side) * drum.velocity_grid, map_side, map_side);

    Analysis analysis{drum,  {drum.radius, drum.length, diameter},
                      chord, detail::collect(trajectory, grouped(frames), shapes, chord, chord_grid, map_grid),
                      0.0,   {},
                      {},    {trajectory.time(frames.front()), trajectory.time(frames.back())}};
    detail::GroupSums total = sum_of(analysis.view.groups, 0, analysis.view.groups.size(), chord_grid.cells());
    analysis.bulk = detail::bulk_packing_fraction(chord_grid, total.chord.volume, static_cast<double>(total.frames), analysis.settings);
    analysis.whole = stretch_of(std::move(total), analysis);
    for (const detail::GroupSums& group : analysis.view.groups) analysis.groups.push_back(stretch_of(group, analysis));

    Observables result;
    result.case_name = header.case_name;
    result.provenance = header.provenance;
    result.status = steadiness(analysis);
    result.values = scalars(analysis);
    result.profiles = {surface_profile(analysis), chord_profile(analysis)};
    for (Profile& profile : velocity_profiles(analysis)) result.profiles.push_back(std::move(profile));
    const double mean_volume = analysis.view.solid_volume / static_cast<double>(header.shape_of_body.size());
    result.maps =
        detail::end_view_maps(analysis.view.map, map_grid, {drum.radius, drum.length, static_cast<double>(frames.size()), mean_volume, analysis.window});
    return result;
}

}  // namespace pelletlab::observables
