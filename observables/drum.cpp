#include "observables/drum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "observables/detail/drum_analysis.hpp"
#include "observables/detail/drum_fields.hpp"
#include "observables/detail/drum_motion.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables {

namespace {

using detail::Analysis;
using detail::Stretch;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double millimetre = 1e-3;
constexpr std::size_t points_per_pellet = 125;
constexpr std::size_t surface_columns = 80;  // of the profile over x, over the drum's diameter

void require_usable(const FrameSource& trajectory, const DrumGeometry& drum) {
    if (!(drum.radius > 0.0) || !(drum.length > 0.0) || !(drum.velocity_grid > 0.0))
        throw bad_input("the drum to measure has no radius, length or velocity grid");
    if (!(drum.pellets_each > 0.0) || drum.view_depth < 0.0) throw bad_input("a body stands for no pellet, or the depth of view is negative");
    if (drum.velocity_grid < drum.radius / 1000.0)
        throw bad_input("a velocity grid of " + std::to_string(drum.velocity_grid / millimetre) + " mm is too fine for this drum",
                        "choose measurement.velocity_grid of at least a thousandth of the drum's radius");
    if (trajectory.header().shape_of_body.empty()) throw bad_input("the trajectory holds no pellets", "run the case again");
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
                                         [&](const Stretch& s) { return s.solid_volume() / (s.bed_area * analysis.settings.drum_length); }));
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

/// The camera's layer, measured as the whole length is: figures «front_…».
void add_front_layer(Observables& result, const FrameSource& trajectory, const std::vector<std::size_t>& frames,
                     const std::vector<detail::PelletPoints>& shapes, const Analysis& whole) {
    const DrumGeometry& drum = whole.drum;
    const double depth = drum.view_depth > 0.0 ? drum.view_depth : 2.0 * whole.settings.pellet_diameter, front = -0.5 * drum.length;
    if (depth >= drum.length) return;
    const Analysis layer = detail::analyse_drum(trajectory, frames, shapes, drum, {front, front + depth, drum.pellets_each});
    for (Observable value : scalars(layer)) {
        value.name = "front_" + value.name;
        result.values.push_back(std::move(value));
    }
}

}  // namespace

Observables measure_drum(const FrameSource& trajectory, const DrumGeometry& drum, const TimeWindow& window) {
    require_usable(trajectory, drum);
    const TrajectoryHeader& header = trajectory.header();
    const std::vector<std::size_t> frames = detail::frames_in(trajectory, window);
    const std::vector<detail::PelletPoints> shapes = detail::sample_shapes(header, points_per_pellet);
    const Analysis analysis = detail::analyse_drum(trajectory, frames, shapes, drum, {drum.slab_begin, drum.slab_end, drum.pellets_each});

    Observables result;
    result.case_name = header.case_name;
    result.provenance = header.provenance;
    result.status = steadiness(analysis);
    result.values = scalars(analysis);
    result.profiles = {surface_profile(analysis), chord_profile(analysis)};
    for (Profile& profile : velocity_profiles(analysis)) result.profiles.push_back(std::move(profile));
    double mean_volume = 0.0;
    for (const std::uint32_t shape : header.shape_of_body) mean_volume += shapes[shape].volume / static_cast<double>(header.shape_of_body.size());
    result.maps = detail::end_view_maps(analysis.view.map, analysis.view.map_grid,
                                        {drum.radius, analysis.settings.drum_length, static_cast<double>(frames.size()), mean_volume, analysis.window});

    const detail::DrumWindow measured{trajectory, frames, analysis, {drum.slab_begin, drum.slab_end, drum.pellets_each}};
    detail::add_active_layer(result, analysis);
    detail::add_speeds(result, measured);
    detail::add_circulation(result, measured);
    detail::add_mixing(result, measured);
    detail::add_weight_torque(result, measured);
    const bool whole_length = !(drum.slab_begin > -0.5 * drum.length) && !(drum.slab_end < 0.5 * drum.length);
    if (drum.depth_known) detail::add_camera(result, measured);
    if (drum.depth_known && whole_length) add_front_layer(result, trajectory, frames, shapes, analysis);
    return result;
}

}  // namespace pelletlab::observables
