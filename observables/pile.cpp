#include "observables/pile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "observables/detail/pellet_points.hpp"
#include "observables/detail/pile_surface.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double millimetre = 1e-3;
constexpr std::size_t sectors = detail::azimuth_sectors;
constexpr double resting_share = 0.95, resting_speed = 0.01;  // share of pellets, speed over √(g d)
constexpr double fewest_layers = 2.0;                         // a pile is higher than that many diameters

/// The last frame with the pouring axis in the origin and heights from the plate.
struct Pile {
    const TrajectoryHeader& header;
    Frame frame;
    std::vector<std::size_t> bodies;    ///< on the plate
    std::vector<double> radius, turn;   ///< of these bodies: distance from the axis [m], azimuth [rad]
    double diameter = 0.0, volume = 0;  ///< mean equivalent diameter [m], of all these pellets [m³]
    std::size_t above = 0;              ///< still in the funnel
};

Pile pile_of(const FrameSource& trajectory, const PileGeometry& geometry) {
    if (!(geometry.height_grid > 0.0)) throw bad_input("the pile to measure has no height grid");
    if (trajectory.frame_count() == 0) throw bad_input("the trajectory holds no frame", "run the case again");
    Pile pile{trajectory.header(), trajectory.frame(trajectory.frame_count() - 1), {}, {}, {}, 0.0, 0.0, 0};
    for (std::size_t body = 0; body < pile.frame.positions.size(); ++body) {
        Vec3& p = pile.frame.positions[body];
        p -= Vec3(geometry.axis_x, geometry.axis_y, geometry.plate);
        if (!pile.frame.is_seen(body) || p.z() < 0.0) continue;
        if (p.z() + geometry.plate > geometry.ceiling) {
            ++pile.above;
            continue;
        }
        const double volume = pile.header.shapes[pile.header.shape_of_body[body]].rigid.mass_properties.volume;
        pile.bodies.push_back(body);
        pile.radius.push_back(std::hypot(p.x(), p.y()));
        pile.turn.push_back(std::atan2(p.y(), p.x()));
        pile.diameter += equivalent_diameter(volume);
        pile.volume += volume;
    }
    if (pile.bodies.empty()) throw bad_input("no pellet lies on the plate", "check the height of the plate and the ceiling against the trajectory");
    if (!(pile.volume > 0.0)) throw bad_input("the pellets have no volume", "check the mass properties of their template");
    pile.diameter /= static_cast<double>(pile.bodies.size());
    return pile;
}

bool at_rest(const Pile& pile) {
    std::vector<double> speeds;
    for (const std::size_t body : pile.bodies)
        if (pile.frame.velocities.size() > body && pile.frame.velocities[body].allFinite()) speeds.push_back(pile.frame.velocities[body].norm());
    const double g = pile.header.gravity.norm() > 0.0 ? pile.header.gravity.norm() : 9.81;
    return speeds.empty() || percentile(std::move(speeds), resting_share) <= resting_speed * std::sqrt(g * pile.diameter);
}

/// 95th percentile of the distance from the axis in each sector; NaN with fewer than 20 pellets, which have no such percentile.
std::vector<double> sector_run_out(const Pile& pile) {
    std::vector<std::vector<double>> radii(sectors);
    for (std::size_t k = 0; k < pile.bodies.size(); ++k) {
        const double turn = (pile.turn[k] + std::numbers::pi) / (2.0 * std::numbers::pi);
        radii[std::min(sectors - 1, static_cast<std::size_t>(turn * static_cast<double>(sectors)))].push_back(pile.radius[k]);
    }
    std::vector<double> run_out;
    for (std::vector<double>& sector : radii) run_out.push_back(sector.size() >= 20 ? percentile(std::move(sector), 0.95) : not_known);
    return run_out;
}

/// Standard error of the mean of four independent values; c4(4) = 0.9213 takes the bias out of their standard deviation.
double error_of_four(const std::array<double, 4>& values) {
    const double mean = 0.25 * (values[0] + values[1] + values[2] + values[3]);
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / 3.0 / 4.0) / 0.9213177319235613;
}

Profile profile_of(const char* name, const char* axis, const std::vector<double>& at, const std::vector<double>& height, const TimeWindow& window,
                   const char* method) {
    Profile profile{name, "mm", axis, "mm", {}, {}, std::vector<double>(at.size(), not_known), window, method};
    for (std::size_t k = 0; k < at.size(); ++k) {
        profile.axis.push_back(at[k] / millimetre);
        profile.value.push_back(height[k] / millimetre);
    }
    return profile;
}

FieldMap surface_map(const detail::HeightGrid& grid, const PileGeometry& geometry, const TimeWindow& window) {
    FieldMap map;
    map.name = "pile_top_surface";
    map.unit = "mm";
    map.horizontal_axis = "x";
    map.vertical_axis = "y";
    map.origin_horizontal = geometry.axis_x - grid.half_count * grid.spacing;
    map.origin_vertical = geometry.axis_y - grid.half_count * grid.spacing;
    map.spacing = grid.spacing;
    map.columns = map.rows = grid.side();
    for (const double height : grid.height) {
        map.value.push_back(std::isfinite(height) ? height / millimetre : not_known);
        map.sample_count.push_back(std::isfinite(height) ? 1.0 : 0.0);
    }
    map.window = window;
    map.method = "pile.top_surface";
    return map;
}

}  // namespace

Observables measure_pile(const FrameSource& trajectory, const PileGeometry& geometry) {
    const Pile pile = pile_of(trajectory, geometry);
    const double d = pile.diameter, ring = std::max(0.5 * d, geometry.height_grid);
    const double run_out = percentile(pile.radius, 0.95);
    const detail::HeightGrid grid = detail::top_surface(pile.header, pile.frame, pile.bodies, run_out + 2.0 * d, geometry.height_grid);
    const double height = detail::smoothed_height(grid, 2.0 * d);
    const detail::Cone cone = height >= fewest_layers * d ? detail::fit_cone(grid, height, ring) : detail::Cone{};
    const TimeWindow instant{pile.frame.time, pile.frame.time};

    Observables result;
    result.case_name = pile.header.case_name;
    result.provenance = pile.header.provenance;
    result.status = !cone.found ? "no pile" : !at_rest(pile) ? "not at rest" : "complete";
    const auto add = [&](const char* name, const char* unit, double value, double error, const char* method) {
        result.values.push_back({name, unit, value, error, instant, method});
    };
    double highest = 0.0;
    for (const double z : grid.height) highest = std::max(highest, z);
    add("pile_height", "mm", height / millimetre, not_known, "pile.height");
    add("pile_height_highest", "mm", highest / millimetre, not_known, "pile.height");
    if (cone.found) {
        add("pile_height_cone", "mm", cone.apex / millimetre, standard_error(cone.sector_apex) / millimetre, "pile.cone");
        add("angle_of_repose_cone", "deg", std::atan(cone.slope) / degree, standard_error(cone.sector_angle) / degree, "pile.cone");
        add("pile_offset", "mm", std::hypot(cone.x, cone.y) / millimetre, not_known, "pile.cone");
        const std::array<double, 2> x = detail::flank_angles(detail::silhouette(grid, true)), y = detail::flank_angles(detail::silhouette(grid, false));
        const std::array<double, 4> sides{x[1], x[0], y[1], y[0]};
        const std::array<const char*, 4> names{"angle_of_repose_plus_x", "angle_of_repose_minus_x", "angle_of_repose_plus_y", "angle_of_repose_minus_y"};
        for (std::size_t k = 0; k < 4; ++k) add(names[k], "deg", sides[k] / degree, not_known, "pile.sides");
        add("angle_of_repose_sides", "deg", 0.25 * (sides[0] + sides[1] + sides[2] + sides[3]) / degree, error_of_four(sides) / degree, "pile.sides");
    }
    add("run_out_95", "mm", run_out / millimetre, standard_error(sector_run_out(pile)) / millimetre, "pile.run_out");

    const detail::RingMeans rings = detail::ring_means(grid, 0.0, 0.0, ring);
    std::vector<double> foot;  // sector by sector
    for (std::size_t s = 0; s < sectors; ++s) {
        std::vector<double> mean;
        for (const auto& sector : rings.sector) mean.push_back(sector[s]);
        foot.push_back(detail::first_below(rings.distance, mean, 0.5 * d));
    }
    add("base_radius", "mm", detail::first_below(rings.distance, rings.mean, 0.5 * d) / millimetre, standard_error(foot) / millimetre, "pile.base");
    double below = 0.0, inside = 0.0;  // [m³], under the top surface; pellets within the grid
    for (const double z : grid.height) below += std::max(0.0, z) * grid.spacing * grid.spacing;
    const double reach = (grid.half_count + 0.5) * grid.spacing;
    for (const std::size_t body : pile.bodies)
        if (std::abs(pile.frame.positions[body].x()) < reach && std::abs(pile.frame.positions[body].y()) < reach)
            inside += pile.header.shapes[pile.header.shape_of_body[body]].rigid.mass_properties.volume;
    add("pile_packing_fraction", "1", inside / below, not_known, "pile.packing");
    add("pellets_counted", "1", static_cast<double>(pile.bodies.size()), not_known, "pile.pellets");
    add("pellets_above", "1", static_cast<double>(pile.above), not_known, "pile.pellets");

    Profile mean = profile_of("pile_profile", "distance_to_axis", rings.distance, rings.mean, instant, "pile.profile");
    for (std::size_t k = 0; k < rings.sector.size(); ++k) mean.standard_error[k] = standard_error(rings.sector[k]) / millimetre;
    const detail::Silhouette along_x = detail::silhouette(grid, true), along_y = detail::silhouette(grid, false);
    result.profiles = {std::move(mean), profile_of("pile_silhouette_x", "x", along_x.place, along_x.height, instant, "pile.silhouette"),
                       profile_of("pile_silhouette_y", "y", along_y.place, along_y.height, instant, "pile.silhouette")};
    result.maps = {surface_map(grid, geometry, instant)};
    return result;
}

}  // namespace pelletlab::observables
