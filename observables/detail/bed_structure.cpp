#include "observables/detail/bed_structure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "observables/detail/clipped_volume.hpp"
#include "observables/detail/convex_overlap.hpp"
#include "observables/detail/near_pairs.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr double pi = std::numbers::pi, millimetre = 1e-3;
constexpr double core_lower = 0.2, core_upper = 0.8;  // of h95
constexpr double contact_gap = 0.01;                  // of the equivalent diameter: true surfaces closer than this touch

TimeWindow instant(const BedInstant& bed) {
    return {bed.frame.time, bed.frame.time};
}

void add_value(Observables& result, const BedInstant& bed, const char* name, const char* unit, double value, const char* method, double error = not_known) {
    result.values.push_back({name, unit, value, error, instant(bed), method});
}

double share(const std::vector<double>& volume, const TubeCells& cells, const std::function<bool(std::size_t ring, std::size_t slice)>& wanted) {
    double solid = 0.0, whole = 0.0;
    for (std::size_t slice = 0; slice < cells.slices(); ++slice)
        for (std::size_t ring = 0; ring < cells.rings(); ++ring)
            if (wanted(ring, slice)) {
                solid += volume[cells.index(ring, slice)];
                whole += cells.volume(ring, slice);
            }
    return whole > 0.0 ? solid / whole : not_known;
}

Profile profile_of(const BedInstant& bed, const char* name, const char* axis, const char* method) {
    return {name, "1", axis, "mm", {}, {}, {}, instant(bed), method};
}

/// Mean of a number over the pellets of each ring of half a diameter, with s/√n of its pellets.
Profile ring_profile(const BedInstant& bed, const char* name, const std::vector<std::pair<double, double>>& distance_and_value) {
    const double ring = 0.5 * bed.diameter;
    const auto rings = static_cast<std::size_t>(std::ceil(bed.tube.radius / ring));
    std::vector<std::vector<double>> values(rings);
    for (const auto& [distance, value] : distance_and_value) values[std::min(rings - 1, static_cast<std::size_t>(distance / ring))].push_back(value);
    Profile profile = profile_of(bed, name, "distance_to_axis", "tube.orientation");
    for (std::size_t k = 0; k < rings; ++k) {
        double squares = 0.0;
        const double mean = mean_of(values[k]), n = static_cast<double>(values[k].size());
        for (const double value : values[k]) squares += (value - mean) * (value - mean);
        profile.axis.push_back((static_cast<double>(k) + 0.5) * ring / millimetre);
        profile.value.push_back(mean);
        profile.standard_error.push_back(n >= 5.0 ? std::sqrt(squares / (n - 1.0) / n) : not_known);
    }
    return profile;
}

struct PairOverlap {
    double depth = 0.0, volume = 0.0;  ///< [m], [m³]; depth < 0: a gap
};

/// Two spheres: depth r₁ + r₂ − s, and the lens between them.
PairOverlap sphere_overlap(double r, double q, double s) {
    const double depth = r + q - s;
    if (depth <= 0.0 || s <= std::abs(r - q)) return {depth, depth > 0.0 ? 4.0 / 3.0 * pi * std::pow(std::min(r, q), 3) : 0.0};
    return {depth, pi * depth * depth * (s * s + 2.0 * s * (r + q) - 3.0 * (r - q) * (r - q)) / (12.0 * s)};
}

}  // namespace

bool add_clipped_packing(Observables& result, const BedInstant& bed) {
    if (!can_be_clipped(bed.header)) return false;
    const double radius = bed.tube.radius, d = bed.diameter;
    const auto rings = static_cast<std::size_t>(std::max(1.0, std::ceil(radius / (0.1 * d))));
    const double step = radius / static_cast<double>(rings);
    const auto slices = static_cast<std::size_t>(std::ceil((bed.h95 + d) / step));
    TubeCells fine;
    for (std::size_t k = 0; k <= rings; ++k) fine.radii.push_back(static_cast<double>(k) * step);
    fine.radii.back() = radius;
    for (std::size_t k = 0; k <= slices; ++k) fine.heights.push_back(static_cast<double>(k) * step);
    const std::vector<double> volume = clipped_volumes(bed.header, bed.frame, bed.bodies, fine);
    const TubeCells core{fine.radii, {core_lower * bed.h95, core_upper * bed.h95}};
    const std::vector<double> in_core = clipped_volumes(bed.header, bed.frame, bed.bodies, core);
    const auto everything = [](std::size_t, std::size_t) { return true; };

    Profile axial = profile_of(bed, "packing_fraction_axial", "height", "tube.axial_profile");
    for (std::size_t k = 0; k < slices; ++k) {
        axial.axis.push_back((static_cast<double>(k) + 0.5) * step / millimetre);
        axial.value.push_back(share(volume, fine, [k](std::size_t, std::size_t slice) { return slice == k; }));
    }
    axial.standard_error.assign(slices, not_known);
    Profile radial = profile_of(bed, "packing_fraction_radial", "distance_to_axis", "tube.radial_profile");
    for (std::size_t k = 0; k < rings; ++k) {
        radial.axis.push_back((static_cast<double>(k) + 0.5) * step / millimetre);
        radial.value.push_back(share(in_core, core, [k](std::size_t ring, std::size_t) { return ring == k; }));
    }
    radial.standard_error.assign(rings, not_known);

    FieldMap map;
    map.name = "packing_fraction";
    map.unit = "1";
    map.horizontal_axis = "distance_to_axis";
    map.vertical_axis = "height";
    map.origin_horizontal = map.origin_vertical = 0.5 * step;
    map.spacing = step;
    map.columns = rings;
    map.rows = slices;
    for (std::size_t slice = 0; slice < slices; ++slice)
        for (std::size_t ring = 0; ring < rings; ++ring) {
            map.value.push_back(volume[fine.index(ring, slice)] / fine.volume(ring, slice));
            map.sample_count.push_back(static_cast<double>(bed.bodies.size()));
        }
    map.window = instant(bed);
    map.method = "tube.packing_map";

    // The wall layer is one diameter wide; rings that straddle its edge count by their middle.
    const auto in_wall_layer = [&](std::size_t ring, std::size_t) { return (static_cast<double>(ring) + 0.5) * step >= radius - d; };
    add_value(result, bed, "packing_fraction_core_clipped", "1", share(in_core, core, everything), "tube.packing_clipped");
    if (std::isfinite(bed.h_grid)) {  // not known in a thin bed
        const TubeCells below{{0.0, radius}, {0.0, bed.h_grid}};
        add_value(result, bed, "packing_fraction_below_grid", "1", share(clipped_volumes(bed.header, bed.frame, bed.bodies, below), below, everything),
                  "tube.packing_clipped");
    }
    add_value(result, bed, "packing_fraction_wall_layer", "1", share(in_core, core, in_wall_layer), "tube.wall_layer");
    add_value(result, bed, "packing_fraction_interior", "1",
              share(in_core, core, [&](std::size_t ring, std::size_t slice) { return !in_wall_layer(ring, slice); }), "tube.wall_layer");
    result.profiles.push_back(std::move(axial));
    result.profiles.push_back(std::move(radial));
    result.maps.push_back(std::move(map));
    return true;
}

void add_orientation(Observables& result, const BedInstant& bed) {
    std::vector<std::pair<double, double>> upright, outward;
    std::vector<double> wall_upright, wall_outward;
    double near_wall = 0.0;
    for (const std::size_t body : bed.bodies) {
        const Vec3& p = bed.frame.positions[body];
        const double distance = p.head<2>().norm();
        const bool at_wall = distance >= bed.tube.radius - 0.75 * bed.diameter;
        if (at_wall) near_wall += 1.0;
        if (!bed.shapes[bed.header.shape_of_body[body]].has_axis) continue;
        const Vec3 axis = bed.frame.orientations[body] * Vec3::UnitZ();
        upright.emplace_back(distance, std::abs(axis.z()));
        if (distance > 0.0) outward.emplace_back(distance, std::abs(axis.x() * p.x() + axis.y() * p.y()) / distance);
        if (at_wall) {
            wall_upright.push_back(upright.back().second);
            wall_outward.push_back(outward.back().second);
        }
    }
    add_value(result, bed, "wall_layer_pellet_share", "1", near_wall / static_cast<double>(bed.bodies.size()), "tube.wall_layer");
    if (upright.empty()) return;
    const auto add_mean = [&](const char* name, const std::vector<double>& values) {
        if (values.size() < 5) return;
        double squares = 0.0;
        const double mean = mean_of(values), n = static_cast<double>(values.size());
        for (const double value : values) squares += (value - mean) * (value - mean);
        add_value(result, bed, name, "1", mean, "tube.wall_layer", std::sqrt(squares / (n - 1.0) / n));
    };
    add_mean("wall_layer_axis_alignment", wall_upright);
    add_mean("wall_layer_axis_radial", wall_outward);
    result.profiles.push_back(ring_profile(bed, "axis_alignment_radial", upright));
    result.profiles.push_back(ring_profile(bed, "axis_radial_radial", outward));
}

void add_overlaps(Observables& result, const BedInstant& bed) {
    const TrajectoryHeader& header = bed.header;
    if (!can_be_clipped(header)) return;
    std::vector<ConvexBody> bodies_of_shape;
    std::vector<double> reach;
    bool convex = true;
    for (const PelletShape& shape : header.shapes) {
        bodies_of_shape.push_back(shape.surface_body.empty() ? ConvexBody{} : convex_body(shape.surface_body));
        double furthest = shape.surface_body.empty() ? shape.rigid.bounding_radius : 0.0;
        for (const Vec3& vertex : shape.surface_body.vertices) furthest = std::max(furthest, vertex.norm());
        reach.push_back(furthest);
        if (!shape.surface_body.empty()) convex = convex && is_convex(shape.surface_body, 1e-5 * furthest);
    }

    // Shell and floor: the furthest vertex decides, and the volume beyond them is what clipping by them takes away.
    std::vector<double> into_wall;
    double solid = 0.0, inside = 0.0;
    for (const std::size_t body : bed.bodies) {
        const std::uint32_t shape = header.shape_of_body[body];
        const Pose pose{bed.frame.positions[body], bed.frame.orientations[body]};
        double depth = -bed.tube.radius;
        for (const Vec3& vertex : bodies_of_shape[shape].vertices) {
            const Vec3 p = pose.to_world(vertex);
            depth = std::max({depth, p.head<2>().norm() - bed.tube.radius, -p.z()});
        }
        if (bodies_of_shape[shape].vertices.empty()) {
            const Sphere& sphere = header.shapes[shape].rigid.spheres.front();
            const Vec3 p = pose.to_world(sphere.centre);
            depth = std::max(std::hypot(p.x(), p.y()) + sphere.radius - bed.tube.radius, sphere.radius - p.z());
        }
        if (depth > 0.0) into_wall.push_back(depth);
    }
    double top = 0.0;
    for (const std::size_t body : bed.bodies) top = std::max(top, bed.frame.positions[body].z() + reach[header.shape_of_body[body]]);
    top *= 1.1;  // above everything, polyhedra of spheres included
    for (const double v : clipped_volumes(header, bed.frame, bed.bodies, {{0.0, bed.tube.radius}, {0.0, top}})) inside += v;
    for (const double v : clipped_volumes(header, bed.frame, bed.bodies, {{0.0, 2.0 * bed.tube.radius + top}, {-top, top}})) solid += v;
    const double d = bed.diameter;
    add_value(result, bed, "wall_overlap_depth_max", "mm", (into_wall.empty() ? 0.0 : *std::max_element(into_wall.begin(), into_wall.end())) / millimetre,
              "tube.wall_overlap");
    add_value(result, bed, "wall_overlap_depth_mean", "mm", (into_wall.empty() ? 0.0 : mean_of(into_wall)) / millimetre, "tube.wall_overlap");
    add_value(result, bed, "wall_overlap_volume_share", "1", std::max(0.0, solid - inside) / solid, "tube.wall_overlap");
    const bool all_spheres = std::all_of(bodies_of_shape.begin(), bodies_of_shape.end(), [](const ConvexBody& body) { return body.vertices.empty(); });
    const bool all_meshes = std::none_of(bodies_of_shape.begin(), bodies_of_shape.end(), [](const ConvexBody& body) { return body.vertices.empty(); });
    if (!convex || !(all_spheres || all_meshes)) return;

    const double gap = contact_gap * d;
    const auto pairs = near_pairs(header, bed.frame, bed.bodies, reach, gap);
    std::vector<PairOverlap> overlaps(pairs.size());
    parallel_for(pairs.size(), 64, [&](std::size_t k) {
        const auto [a, b] = pairs[k];
        const std::uint32_t shape_a = header.shape_of_body[a], shape_b = header.shape_of_body[b];
        const auto& p = bed.frame.positions;
        if (all_spheres) {
            overlaps[k] = sphere_overlap(reach[shape_a], reach[shape_b], (p[a] - p[b]).norm());
            return;
        }
        const ConvexBody first = moved(bodies_of_shape[shape_a], {p[a], bed.frame.orientations[a]}),
                         second = moved(bodies_of_shape[shape_b], {p[b], bed.frame.orientations[b]});
        overlaps[k].depth = penetration(first, second, gap);
        if (overlaps[k].depth > 0.0) overlaps[k].volume = common_volume(first, second);
    });
    std::vector<double> depths;
    double contacts = 0.0, volume = 0.0;
    for (const PairOverlap& overlap : overlaps) {
        if (overlap.depth >= -gap) contacts += 1.0;
        if (overlap.depth <= 0.0) continue;
        depths.push_back(overlap.depth);
        volume += std::max(0.0, overlap.volume);
    }
    const double pellets = static_cast<double>(bed.bodies.size());
    add_value(result, bed, "true_neighbours_per_pellet", "1", 2.0 * contacts / pellets, "tube.true_contacts");
    add_value(result, bed, "true_overlaps_per_pellet", "1", 2.0 * static_cast<double>(depths.size()) / pellets, "tube.true_overlap");
    add_value(result, bed, "true_overlap_depth_mean", "mm", (depths.empty() ? 0.0 : mean_of(depths)) / millimetre, "tube.true_overlap");
    add_value(result, bed, "true_overlap_depth_p95", "mm", (depths.empty() ? 0.0 : percentile(depths, 0.95)) / millimetre, "tube.true_overlap");
    add_value(result, bed, "true_overlap_depth_max", "mm", (depths.empty() ? 0.0 : *std::max_element(depths.begin(), depths.end())) / millimetre,
              "tube.true_overlap");
    add_value(result, bed, "true_overlap_volume_share", "1", volume / solid, "tube.true_overlap");
}

}  // namespace pelletlab::observables::detail
