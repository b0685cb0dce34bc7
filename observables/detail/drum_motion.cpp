#include "observables/detail/drum_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "observables/detail/camera_view.hpp"
#include "observables/detail/circulation.hpp"
#include "observables/detail/drum_fields.hpp"
#include "observables/detail/pellet_motion.hpp"
#include "observables/mixing.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr double millimetre = 1e-3, milli = 1e-3;
constexpr std::size_t speed_bins = 100;
constexpr double bin_of_wall_speed = 0.05;
constexpr double mixing_cell = 3.0;          // pellet diameters
constexpr std::size_t mixing_instants = 50;  // at most
constexpr double fewest_passages = 5.0;

/// Depth at which the mean downhill velocity changes sign, linear between bins; NaN when it does not.
double depth_of_rest(const std::vector<double>& velocity, double bin) {
    for (std::size_t k = 1; k < velocity.size(); ++k)
        if (velocity[k - 1] > 0.0 && velocity[k] <= 0.0) return (static_cast<double>(k) - 0.5 + velocity[k - 1] / (velocity[k - 1] - velocity[k])) * bin;
    return not_known;
}

double thickness_at_mid_chord(const Stretch& s, double radius) {
    std::vector<double> thickness;
    for (std::size_t c = 0; c < s.surface.xi.size(); ++c) {
        const double share = (s.surface.xi[c] - s.surface.begin) / (s.surface.end - s.surface.begin), xi = s.surface.xi[c];
        if (share >= 0.4 && share <= 0.6) thickness.push_back(s.surface.eta[c] + std::sqrt(std::max(0.0, radius * radius - xi * xi)));
    }
    return mean_of(thickness);
}

double bin_width(const DrumGeometry& drum, double largest) {
    const double wall = std::abs(drum.rotation_speed) * drum.radius;
    return wall > 0.0 ? bin_of_wall_speed * wall : std::max(largest, 1e-12) / static_cast<double>(speed_bins);
}

Profile speed_profile(const char* name, double width, const TimeWindow& window, const char* method) {
    Profile profile{name, "s/m", "speed", "m/s", {}, {}, std::vector<double>(speed_bins, not_known), window, method};
    for (std::size_t k = 0; k < speed_bins; ++k) profile.axis.push_back((static_cast<double>(k) + 0.5) * width);
    return profile;
}

/// Cells of the motion grid whose pellets go downhill on the mean.
std::vector<bool> downhill(const MotionSums& sums, const ChordFrame& chord) {
    std::vector<bool> active;
    for (std::size_t cell = 0; cell < sums.count.size(); ++cell) active.push_back(chord.to_chord(sums.velocity[cell].x(), sums.velocity[cell].z()).a > 0.0);
    return active;
}

/// 1 for the bodies whose number lies above the median, 0 for the others.
std::vector<std::uint8_t> upper_half(const std::vector<double>& number) {
    std::vector<double> known;
    for (const double value : number)
        if (std::isfinite(value)) known.push_back(value);
    const double middle = known.empty() ? 0.0 : percentile(std::move(known), 0.5);
    std::vector<std::uint8_t> label;
    for (const double value : number) label.push_back(value > middle ? 1 : 0);
    return label;
}

}  // namespace

void add_active_layer(Observables& result, const Analysis& analysis) {
    const double bin = 0.5 * analysis.settings.pellet_diameter;
    const auto bins = static_cast<std::size_t>(std::ceil(analysis.drum.radius / bin));
    const auto velocities = [&](const Stretch& s) { return depth_velocity(s.sums.chord, s.surface, analysis.view.chord_grid, bin, bins); };
    if (!std::isfinite(depth_of_rest(velocities(analysis.whole), bin))) return;  // nothing flows down
    result.values.push_back(
        analysis.observable("active_layer_depth", "mm", millimetre, "drum.active_layer", [&](const Stretch& s) { return depth_of_rest(velocities(s), bin); }));
    result.values.push_back(analysis.observable("active_layer_thickness_share", "1", 1.0, "drum.active_layer", [&](const Stretch& s) {
        return depth_of_rest(velocities(s), bin) / thickness_at_mid_chord(s, analysis.drum.radius);
    }));
    result.values.push_back(analysis.observable("mid_chord_surface_speed", "m/s", 1.0, "drum.active_layer", [&](const Stretch& s) {
        const std::vector<double> v = velocities(s);
        return 1.5 * v[0] - 0.5 * v[1];
    }));
}

void add_speeds(Observables& result, const DrumWindow& window) {
    const Analysis& analysis = window.analysis;
    const double diameter = analysis.settings.pellet_diameter;
    const PelletMotion motion = pellet_motion(window.trajectory, grouped(window.frames), analysis.drum.radius, diameter, window.filter);
    const MotionSums whole = motion.whole();
    if (whole.speeds.empty()) return;
    const auto add = [&](const std::string& name, const char* unit, const char* method, const std::function<double(const MotionSums&)>& figure) {
        std::vector<double> series;
        for (const MotionSums& group : motion.groups) series.push_back(group.speeds.empty() ? not_known : figure(group));
        result.values.push_back({name, unit, figure(whole), standard_error(series), analysis.window, method});
    };
    add("speed_mean", "m/s", "drum.speed_distribution", [](const MotionSums& s) { return mean_of(s.speeds); });
    for (const int percent : {10, 50, 90, 99})
        add("speed_p" + std::to_string(percent), "m/s", "drum.speed_distribution",
            [percent](const MotionSums& s) { return percentile(s.speeds, 0.01 * percent); });
    const std::vector<bool> all(motion.grid.cells(), true), active = downhill(whole, analysis.chord);
    add("granular_temperature", "m^2/s^2", "drum.granular_temperature", [&](const MotionSums& s) { return granular_temperature(s, all); });
    add("granular_temperature_active", "m^2/s^2", "drum.granular_temperature", [&](const MotionSums& s) { return granular_temperature(s, active); });

    const double width = bin_width(analysis.drum, *std::max_element(whole.speeds.begin(), whole.speeds.end()));
    Profile profile = speed_profile("speed_distribution", width, analysis.window, "drum.speed_distribution");
    profile.value = density(whole.speeds, width, speed_bins);
    std::vector<std::vector<double>> of_group;
    for (const MotionSums& group : motion.groups) of_group.push_back(density(group.speeds, width, speed_bins));
    for (std::size_t k = 0; k < speed_bins; ++k) {
        std::vector<double> series;
        for (const auto& one : of_group) series.push_back(one[k]);
        profile.standard_error[k] = standard_error(series);
    }
    result.profiles.push_back(std::move(profile));

    FieldMap map = empty_map("granular_temperature", "m^2/s^2", "drum.granular_temperature", motion.grid, analysis.window);
    map.value = temperature_of_cells(whole);
    map.sample_count = whole.count;
    result.maps.push_back(std::move(map));
}

void add_circulation(Observables& result, const DrumWindow& window) {
    const Analysis& analysis = window.analysis;
    const double diameter = analysis.settings.pellet_diameter;
    const std::vector<double> line = zero_velocity_line(analysis.whole.sums.chord, analysis.whole.surface, analysis.view.chord_grid, diameter);
    const std::vector<Circulation> groups =
        circulate(window.trajectory, grouped(window.frames), analysis.chord, analysis.view.chord_grid, line, diameter, window.filter);
    Circulation whole;
    for (const Circulation& group : groups) {
        whole.active_time += group.active_time;
        whole.passive_time += group.passive_time;
        whole.into_active += group.into_active;
        whole.into_passive += group.into_passive;
    }
    if (whole.into_active < fewest_passages || whole.into_passive < fewest_passages) return;
    const auto ratio = [](double time, double passages) { return passages > 0.0 ? time / passages : not_known; };
    const auto add = [&](const char* name, const char* unit, const std::function<double(const Circulation&)>& figure) {
        std::vector<double> series;
        for (const Circulation& group : groups) series.push_back(figure(group));
        result.values.push_back({name, unit, figure(whole), standard_error(series), analysis.window, "drum.circulation"});
    };
    add("active_share", "1", [&](const Circulation& c) { return ratio(c.active_time, c.active_time + c.passive_time); });
    add("active_residence_time", "s", [&](const Circulation& c) { return ratio(c.active_time, c.into_active); });
    add("passive_residence_time", "s", [&](const Circulation& c) { return ratio(c.passive_time, c.into_passive); });
    add("circulation_time", "s", [&](const Circulation& c) { return ratio(c.active_time + c.passive_time, 0.5 * (c.into_active + c.into_passive)); });
}

void add_mixing(Observables& result, const DrumWindow& window) {
    const Analysis& analysis = window.analysis;
    const std::vector<std::size_t>& frames = window.frames;
    const double cell = mixing_cell * analysis.settings.pellet_diameter;
    const Frame first = window.trajectory.frame(frames.front());
    std::vector<double> along, outward, deep;
    for (std::size_t body = 0; body < first.positions.size(); ++body) {
        const Vec3& p = first.positions[body];
        const bool counts = first.is_seen(body) && p.y() >= window.filter.y_begin && p.y() < window.filter.y_end;
        along.push_back(counts ? analysis.chord.to_chord(p.x(), p.z()).a : not_known);
        outward.push_back(counts ? std::hypot(p.x(), p.z()) : not_known);
        deep.push_back(counts ? p.y() : not_known);
    }
    struct Labelling {
        std::string name;
        std::vector<std::uint8_t> label;
    };
    std::vector<Labelling> labellings{{"mixing_index_left_right", upper_half(along)}, {"mixing_index_inner_outer", upper_half(outward)}};
    if (analysis.drum.depth_known) labellings.push_back({"mixing_index_front_back", upper_half(deep)});
    const std::size_t instants = std::min(mixing_instants, frames.size());
    std::vector<Profile> profiles;
    for (const Labelling& one : labellings) profiles.push_back({one.name, "1", "time", "s", {}, {}, {}, analysis.window, "drum.mixing"});
    for (std::size_t k = 0; k < instants; ++k) {
        Frame now = window.trajectory.frame(frames[instants > 1 ? k * (frames.size() - 1) / (instants - 1) : 0]);
        for (std::size_t body = 0; body < now.positions.size(); ++body)
            if (!std::isfinite(along[body])) now.positions[body].setConstant(not_known);  // without a label
        for (std::size_t i = 0; i < labellings.size(); ++i) {
            profiles[i].axis.push_back(now.time - first.time);
            profiles[i].value.push_back(lacey_index(now.positions, labellings[i].label, cell));
            profiles[i].standard_error.push_back(not_known);
        }
    }
    for (Profile& profile : profiles) {
        if (!std::isfinite(profile.value.back())) continue;
        result.values.push_back({profile.name, "1", profile.value.back(), not_known, analysis.window, "drum.mixing"});
        result.profiles.push_back(std::move(profile));
    }
}

void add_camera(Observables& result, const DrumWindow& window) {
    const Analysis& analysis = window.analysis;
    const DrumGeometry& drum = analysis.drum;
    const double depth = drum.view_depth > 0.0 ? drum.view_depth : 2.0 * analysis.settings.pellet_diameter;
    const CameraSums seen = look(window.trajectory, window.frames, {drum.radius, -0.5 * drum.length, depth, drum.camera_grid});
    std::vector<FieldMap> maps = camera_maps(seen, analysis.window);
    std::vector<double> speeds;
    for (const double speed : maps.front().value)
        if (std::isfinite(speed)) speeds.push_back(speed);
    if (speeds.empty()) return;
    const double width = bin_width(drum, *std::max_element(speeds.begin(), speeds.end()));
    Profile profile = speed_profile("camera_speed_distribution", width, analysis.window, "drum.camera_speed_distribution");
    profile.value = density(speeds, width, speed_bins);
    result.values.push_back({"camera_speed_mean", "m/s", mean_of(speeds), not_known, analysis.window, "drum.camera_speed_distribution"});
    for (const int percent : {50, 90, 99})
        result.values.push_back({"camera_speed_p" + std::to_string(percent), "m/s", percentile(speeds, 0.01 * percent), not_known, analysis.window,
                                 "drum.camera_speed_distribution"});
    result.profiles.push_back(std::move(profile));
    for (FieldMap& map : maps) result.maps.push_back(std::move(map));
}

void add_weight_torque(Observables& result, const DrumWindow& window) {
    const TrajectoryHeader& header = window.trajectory.header();
    const double density = header.shapes.front().rigid.mass_properties.density;
    for (const PelletShape& shape : header.shapes)
        if (!(shape.rigid.mass_properties.density > 0.0) || shape.rigid.mass_properties.density != density) return;
    const Analysis& analysis = window.analysis;
    const ViewGrid& grid = analysis.view.chord_grid;
    const auto torque = [&](const Stretch& s) {
        double moment = 0.0;  // [m⁴], Σ V x of the mirrored world
        for (std::size_t cell = 0; cell < grid.cells(); ++cell)
            moment += s.sums.chord.volume[cell] *
                      (analysis.chord.out_z * grid.centre_a(cell % grid.columns) + analysis.chord.out_x * grid.centre_b(cell / grid.columns));
        return -density * header.gravity.norm() * moment / static_cast<double>(s.sums.frames);
    };
    result.values.push_back(analysis.observable("bed_torque", "mN*m", milli, "drum.bed_torque", torque));
    const double speed = std::abs(analysis.drum.rotation_speed);
    if (speed > 0.0)
        result.values.push_back(analysis.observable("bed_power", "mW", milli, "drum.bed_torque", [&](const Stretch& s) { return speed * torque(s); }));
}

}  // namespace pelletlab::observables::detail
