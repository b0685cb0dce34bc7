#include "observables/lying_bed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "observables/detail/top_surface.hpp"

namespace pelletlab::observables {

namespace {

constexpr double millimetre = 1e-3;
constexpr double middle = 0.5;           // of the radius: grid lines further out see the rising shell below a thin bed
constexpr double most_bare_floor = 0.1;  // of the grid lines

/// The level whose segment has its centroid at z [m].
double level_of_centroid(double radius, double z) {
    double below = -radius, above = radius;
    for (int halving = 0; halving < 60; ++halving) {
        const double level = 0.5 * (below + above);
        (segment_centroid(radius, level) < z ? below : above) = level;
    }
    return 0.5 * (below + above);
}

}  // namespace

double segment_area(double radius, double level) {
    const double z = std::clamp(level / radius, -1.0, 1.0);
    return radius * radius * (std::numbers::pi - std::acos(z) + z * std::sqrt(1.0 - z * z));
}

double segment_centroid(double radius, double level) {
    const double z = std::clamp(level / radius, -1.0, 1.0), area = segment_area(radius, level);
    // ∫ z dA below the chord: −⅔ (R² − level²)^(3/2).
    return area > 0.0 ? -2.0 / 3.0 * std::pow(radius * radius * (1.0 - z * z), 1.5) / area : -radius;
}

Observables measure_lying_bed(const FrameSource& trajectory, const LyingGeometry& vessel) {
    if (!(vessel.radius > 0.0) || !(vessel.length > 0.0) || !(vessel.height_grid > 0.0))
        throw bad_input("the lying vessel to measure in has no radius, length or height grid");
    if (trajectory.frame_count() == 0) throw bad_input("the trajectory holds no frame", "run the case again");
    const TrajectoryHeader& header = trajectory.header();
    const Frame frame = trajectory.frame(trajectory.frame_count() - 1);
    std::vector<std::size_t> bodies;
    double volume = 0.0, moment = 0.0, diameter = 0.0;
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        const Vec3& p = frame.positions[body];
        if (!frame.is_seen(body) || std::hypot(p.x(), p.z()) > vessel.radius || std::abs(p.y()) > 0.5 * vessel.length) continue;
        const double v = header.shapes[header.shape_of_body[body]].rigid.mass_properties.volume;
        bodies.push_back(body);
        volume += v;
        moment += v * p.z();
        diameter += equivalent_diameter(v);
    }
    if (bodies.empty() || !(volume > 0.0)) throw bad_input("no pellet lies inside the vessel", "check its radius and length against the trajectory");
    diameter /= static_cast<double>(bodies.size());

    const double half_y = 0.5 * (vessel.length - diameter), half_x = middle * vessel.radius;
    const detail::HeightGrid grid = detail::top_surface(header, frame, bodies, std::max(vessel.radius, 0.5 * vessel.length), vessel.height_grid);
    double sum = 0.0, highest = -vessel.radius;
    std::size_t lines = 0, bare = 0;
    for (int j = -grid.half_count; j <= grid.half_count; ++j)
        for (int i = -grid.half_count; i <= grid.half_count; ++i) {
            const double x = i * grid.spacing, y = j * grid.spacing, z = grid.height[grid.index(i, j)];
            highest = std::max(highest, z);
            if (std::abs(x) > half_x || std::abs(y) > half_y) continue;
            ++lines;
            if (std::isfinite(z))
                sum += z;
            else
                ++bare;
        }
    const bool thin = lines == 0 || static_cast<double>(bare) > most_bare_floor * static_cast<double>(lines);
    const double level_grid = thin ? not_known : sum / static_cast<double>(lines - bare), centre = moment / volume;
    const double level_mass = level_of_centroid(vessel.radius, centre);
    const TimeWindow instant{frame.time, frame.time};
    Observables result;
    result.case_name = header.case_name;
    result.provenance = header.provenance;
    if (thin) result.status = "thin bed";
    const auto add = [&](const char* name, const char* unit, double value, const char* method) {
        result.values.push_back({name, unit, value, not_known, instant, method});
    };
    const double whole = std::numbers::pi * vessel.radius * vessel.radius * vessel.length;
    add("fill_level_grid", "mm", (level_grid + vessel.radius) / millimetre, "lying.top_surface");
    add("fill_level_mass", "mm", (level_mass + vessel.radius) / millimetre, "lying.centre_of_mass");
    add("fill_level_highest", "mm", (highest + vessel.radius) / millimetre, "lying.highest");
    add("mean_centroid_height", "mm", (centre + vessel.radius) / millimetre, "lying.centre_of_mass");
    add("packing_fraction_grid", "1", volume / (segment_area(vessel.radius, level_grid) * vessel.length), "lying.packing");
    add("packing_fraction_mass", "1", volume / (segment_area(vessel.radius, level_mass) * vessel.length), "lying.packing");
    add("fill_fraction_grid", "1", segment_area(vessel.radius, level_grid) * vessel.length / whole, "lying.fill_fraction");
    add("fill_fraction_mass", "1", segment_area(vessel.radius, level_mass) * vessel.length / whole, "lying.fill_fraction");
    add("pellets_counted", "1", static_cast<double>(bodies.size()), "lying.pellets_counted");
    return result;
}

}  // namespace pelletlab::observables
