// M3 to M6: where the picture's surface is put, its scale, its roll and its clock. Frame of the drum: centre in the origin, x to the right, z up; a positive
// angle of repose falls to the right, so a camera rolled by a adds a to every angle and lowers the surface by x tan a. Profiles keep their places: the changed
// profile is read there again, linear between bins, unknown outside.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

namespace {

double at(const Profile& p, double x) {
    const auto upper = std::lower_bound(p.axis.begin(), p.axis.end(), x);
    if (p.axis.empty() || x < p.axis.front() || x > p.axis.back()) return not_known;
    const auto j = static_cast<std::size_t>(upper - p.axis.begin());
    if (p.axis[j] == x) return p.value[j];
    const double t = (x - p.axis[j - 1]) / (p.axis[j] - p.axis[j - 1]);
    return (1.0 - t) * p.value[j - 1] + t * p.value[j];
}

bool is(const std::string& name, const std::string& what) {
    return name == what || name == "front_" + what;
}

template <class Change>
void on_values(Observables& o, const std::vector<std::string>& names, Change change) {
    for (Observable& value : o.values)
        if (std::any_of(names.begin(), names.end(), [&](const std::string& n) { return is(value.name, n); })) value.value = change(value.value);
}

template <class Change>
void on_profiles(Observables& o, const std::string& name, Change change) {
    for (Profile& p : o.profiles)
        if (is(p.name, name)) change(p);
}

double highest(const Profile& p) {
    double most = not_known;
    for (const double z : p.value)
        if (!(most >= z)) most = std::isnan(z) ? most : z;
    return most;
}

const std::vector<std::string>& velocities() {
    static const std::vector<std::string> names{
        "surface_velocity", "mid_chord_surface_speed", "speed_mean",       "speed_p10",        "speed_p50",       "speed_p90",
        "speed_p99",        "camera_speed_mean",       "camera_speed_p50", "camera_speed_p90", "camera_speed_p99"};
    return names;
}

void scale_velocities(Observables& o, double factor) {
    on_values(o, velocities(), [factor](double v) { return factor * v; });
    for (const char* name : {"depth_velocity", "surface_velocity"})
        on_profiles(o, name, [factor](Profile& p) {
            for (double& v : p.value) v *= factor;
        });
}

void shift_surface(Observables& o, double offset) {
    on_values(o, {"bed_height"}, [offset](double h) { return h + offset; });
    for (const char* name : {"free_surface", "free_surface_chord"})
        on_profiles(o, name, [offset](Profile& p) {
            for (double& z : p.value) z += offset;
        });
}

void scale_picture(Observables& o, double a) {
    scale_velocities(o, 1.0 + a);
    on_values(o, {"bed_height", "active_layer_depth"}, [a](double h) { return (1.0 + a) * h; });
    for (const char* name : {"free_surface", "free_surface_chord"})
        on_profiles(o, name, [a](Profile& p) {
            const Profile before = p;
            for (std::size_t i = 0; i < p.axis.size(); ++i) p.value[i] = (1.0 + a) * at(before, p.axis[i] / (1.0 + a));
        });
    for (const char* name : {"depth_velocity", "surface_velocity"})
        on_profiles(o, name, [a](Profile& p) {
            const Profile before = p;
            for (std::size_t i = 0; i < p.axis.size(); ++i) {
                const double there = at(before, p.axis[i] / (1.0 + a));
                p.value[i] = std::isnan(there) ? p.value[i] : there;  // the first and last half bin
            }
        });
}

void roll_picture(Observables& o, double degrees) {
    const double slope = std::tan(degrees * std::numbers::pi / 180.0);
    on_values(o, {"upper_angle_of_repose", "lower_angle_of_repose", "dynamic_angle_of_repose", "centre_of_mass_angle"},
              [degrees](double angle) { return angle + degrees; });
    on_profiles(o, "free_surface", [&](Profile& p) {
        const double before = highest(p);
        for (std::size_t i = 0; i < p.axis.size(); ++i) p.value[i] -= slope * p.axis[i];
        const double change = highest(p) - before;
        for (Observable& value : o.values)
            if (value.name == (p.name == "free_surface" ? "bed_height" : "front_bed_height") && std::isfinite(change)) value.value += change;
    });
}

}  // namespace

std::vector<Effect> camera_geometry_effects() {
    return {
        {"M3",
         "surface_threshold",
         "another threshold for the surface",
         "free surface and bed height + a",
         "half a pellet up or down; range of this project",
         "measurement",
         "mm",
         1.75,
         true,
         {},
         {},
         "the same code on pictures and simulation",
         {},
         shift_surface},
        {"M4",
         "camera_scale",
         "scale of the picture",
         "lengths about the axis and velocities (1 + a); angles unchanged",
         "calibration target nearer or farther than the bed; range of this project",
         "measurement",
         "1",
         0.05,
         true,
         {},
         {},
         "measure the drum's diameter in the picture",
         {},
         scale_picture},
        {"M5",
         "camera_roll",
         "the camera is rolled",
         "angles + a, surface turned by a",
         "range of this project",
         "measurement",
         "deg",
         1.0,
         true,
         {},
         {},
         "a plumb line in the picture",
         {},
         roll_picture},
        {"M6",
         "frame_rate",
         "frame rate of the camera",
         "all velocities (1 + a)",
         "range of this project",
         "measurement",
         "1",
         0.1,
         true,
         {},
         {},
         "film a stopwatch",
         {},
         [](Observables& o, double a) { scale_velocities(o, 1.0 + a); }},
    };
}

}  // namespace pelletlab::experiments::effects
