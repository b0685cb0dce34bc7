#include "observables/bed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "observables/detail/bed_structure.hpp"
#include "observables/detail/pellet_points.hpp"
#include "observables/detail/resting_plate.hpp"
#include "observables/detail/top_surface.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double millimetre = 1e-3;
constexpr double core_lower = 0.2, core_upper = 0.8;  // of h95
constexpr std::size_t points_per_pellet = 500;        // the profiles of one frame afford many

/// One instant of the bed, heights counted from the floor.
struct Bed {
    const TrajectoryHeader& header;
    const Frame& frame;
    const TubeGeometry& tube;
    std::vector<detail::PelletPoints> shapes;
    std::vector<std::size_t> bodies;  ///< those inside the tube

    const detail::PelletPoints& shape_of(std::size_t body) const { return shapes[header.shape_of_body[body]]; }
    double height_of(std::size_t body) const { return frame.positions[body].z() - tube.floor; }
    double cross_section() const { return pi * tube.radius * tube.radius; }
};

template <class Term>
double sum_over(const Bed& bed, const Term& term) {
    double sum = 0.0;
    for (const std::size_t body : bed.bodies) sum += term(body);
    return sum;
}

void require_usable(const FrameSource& trajectory, const TubeGeometry& tube) {
    if (!(tube.radius > 0.0) || !(tube.height_grid > 0.0)) throw bad_input("the tube to measure in has no radius or no height grid");
    if (trajectory.frame_count() == 0) throw bad_input("the trajectory holds no frame", "run the case again");
}

std::vector<std::size_t> bodies_inside(const Frame& frame, const TubeGeometry& tube) {
    std::vector<std::size_t> bodies;
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        const Vec3& p = frame.positions[body];
        if (std::hypot(p.x(), p.y()) <= tube.radius && p.z() >= tube.floor) bodies.push_back(body);
    }
    if (bodies.empty()) throw bad_input("no pellet lies inside the tube", "check the tube's radius and floor against the trajectory");
    return bodies;
}

constexpr double most_bare_floor = 0.1;  // of the grid lines; with more the bed has no top surface

/// Mean height of the top surface over the grid lines within `reach` of the axis; a line that meets no pellet counts with height 0, the floor. Not known when
/// more than a tenth of the lines meet none: the pellets do not cover the floor, and the mean would be no height of a bed.
double grid_height(const Bed& bed, double reach) {
    const detail::HeightGrid grid = detail::top_surface(bed.header, bed.frame, bed.bodies, reach, bed.tube.height_grid);
    double sum = 0.0;
    std::size_t lines = 0, bare = 0;
    for (int j = -grid.half_count; j <= grid.half_count; ++j)
        for (int i = -grid.half_count; i <= grid.half_count; ++i) {
            if (std::hypot(i, j) * grid.spacing > reach) continue;
            const double height = grid.height[grid.index(i, j)] - bed.tube.floor;
            if (!(height > 0.0)) ++bare;
            sum += std::max(0.0, height);
            ++lines;
        }
    return static_cast<double>(bare) > most_bare_floor * static_cast<double>(lines) ? not_known : sum / static_cast<double>(lines);
}

/// Mean over the pellets that have an axis of |axis·z|; 0.5 for random orientations. NaN when no pellet has one.
double mean_axis_alignment(const Bed& bed) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const std::size_t body : bed.bodies)
        if (bed.shape_of(body).has_axis) {
            sum += std::abs((bed.frame.orientations[body] * Vec3::UnitZ()).z());
            ++count;
        }
    return count > 0 ? sum / static_cast<double>(count) : not_known;
}

/// Where the pellets are clumps without a surface: packing fraction in slices or rings from the volume points of every pellet: pellet volume in the bin /
/// volume of the bin.
struct PackingProfiles {
    Profile axial, radial;
};

PackingProfiles packing_profiles(const Bed& bed, double h95, double mean_diameter) {
    const double top = h95 + mean_diameter;
    const auto slices = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(top / (0.1 * mean_diameter))));
    const double slice = top / static_cast<double>(slices);
    const auto rings = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(bed.tube.radius / (0.1 * mean_diameter))));
    const double ring = bed.tube.radius / static_cast<double>(rings);
    std::vector<double> in_slice(slices, 0.0), in_ring(rings, 0.0);
    for (const std::size_t body : bed.bodies) {
        const detail::PelletPoints& pellet = bed.shape_of(body);
        const double weight = pellet.volume / static_cast<double>(pellet.points_body.size());
        for (const Vec3& point : pellet.points_body) {
            const Vec3 p = bed.frame.orientations[body] * point + bed.frame.positions[body];
            const double z = p.z() - bed.tube.floor, rho = std::hypot(p.x(), p.y());
            if (z >= 0.0 && z < top) in_slice[static_cast<std::size_t>(z / slice)] += weight;
            if (z >= core_lower * h95 && z < core_upper * h95 && rho < bed.tube.radius) in_ring[static_cast<std::size_t>(rho / ring)] += weight;
        }
    }
    PackingProfiles profiles;
    const TimeWindow instant{bed.frame.time, bed.frame.time};
    profiles.axial = {"packing_fraction_axial", "1", "height", "mm", {}, {}, std::vector<double>(slices, not_known), instant, "tube.axial_profile"};
    for (std::size_t k = 0; k < slices; ++k) {
        profiles.axial.axis.push_back((static_cast<double>(k) + 0.5) * slice / millimetre);
        profiles.axial.value.push_back(in_slice[k] / (bed.cross_section() * slice));
    }
    profiles.radial = {"packing_fraction_radial", "1", "distance_to_axis", "mm", {}, {}, std::vector<double>(rings, not_known), instant, "tube.radial_profile"};
    for (std::size_t k = 0; k < rings; ++k) {
        const double inner = static_cast<double>(k) * ring, outer = inner + ring;
        profiles.radial.axis.push_back((inner + 0.5 * ring) / millimetre);
        profiles.radial.value.push_back(in_ring[k] / (pi * (outer * outer - inner * inner) * (core_upper - core_lower) * h95));
    }
    return profiles;
}

}  // namespace

Observables measure_tube_bed(const FrameSource& trajectory, const TubeGeometry& tube) {
    require_usable(trajectory, tube);
    const TrajectoryHeader& header = trajectory.header();
    const Frame frame = trajectory.frame(trajectory.frame_count() - 1);
    const Bed bed{header, frame, tube, detail::sample_shapes(header, points_per_pellet), bodies_inside(frame, tube)};

    const double count = static_cast<double>(bed.bodies.size());
    const double solid_volume = sum_over(bed, [&](std::size_t body) { return bed.shape_of(body).volume; });
    const double mean_diameter = sum_over(bed, [&](std::size_t body) { return bed.shape_of(body).equivalent_diameter; }) / count;
    const double mean_centroid = sum_over(bed, [&](std::size_t body) { return bed.height_of(body); }) / count;
    std::vector<double> tops;
    for (const std::size_t body : bed.bodies) tops.push_back(bed.height_of(body) + bed.shape_of(body).half_height);

    const double margin = tube.edge_margin > 0.0 ? tube.edge_margin : 0.5 * mean_diameter;
    if (margin >= tube.radius) throw bad_input("the tube is narrower than one pellet, so its bed has no top surface", "use a wider tube");
    const double h_grid = grid_height(bed, tube.radius - margin);
    const double h95 = percentile(tops, 0.95);
    const double h100 = *std::max_element(tops.begin(), tops.end());
    const double h_mass = 2.0 * mean_centroid;
    const detail::RestingPlate plate = detail::resting_plate(header, frame, bed.bodies, tube.radius);
    const double h_plate = plate.height - tube.floor;
    const double core_volume = sum_over(bed, [&](std::size_t body) {
        const double z = bed.height_of(body);
        return z >= core_lower * h95 && z < core_upper * h95 ? bed.shape_of(body).volume : 0.0;
    });
    const double area = bed.cross_section();

    Observables result;
    result.case_name = header.case_name;
    if (std::isnan(h_grid)) result.status = "thin bed";
    result.provenance = header.provenance;
    const auto add = [&](const char* name, const char* unit, double value, const char* method) {
        result.values.push_back({name, unit, value, not_known, {frame.time, frame.time}, method});
    };
    add("bed_height_grid", "mm", h_grid / millimetre, "tube.top_surface");
    add("bed_height_h95", "mm", h95 / millimetre, "tube.h95");
    add("bed_height_h100", "mm", h100 / millimetre, "tube.h100");
    add("bed_height_mass", "mm", h_mass / millimetre, "tube.centre_of_mass");
    add("bed_height_plate", "mm", h_plate / millimetre, "tube.plate");
    add("plate_tilt", "deg", plate.tilt * 180.0 / pi, "tube.plate");
    add("packing_fraction_grid", "1", solid_volume / (area * h_grid), "tube.packing");
    add("packing_fraction_h95", "1", solid_volume / (area * h95), "tube.packing");
    add("packing_fraction_h100", "1", solid_volume / (area * h100), "tube.packing");
    add("packing_fraction_mass", "1", solid_volume / (area * h_mass), "tube.packing");
    add("packing_fraction_plate", "1", solid_volume / (area * h_plate), "tube.packing");
    add("packing_fraction_core", "1", core_volume / (area * (core_upper - core_lower) * h95), "tube.packing_core");
    add("mean_centroid_height", "mm", mean_centroid / millimetre, "tube.centre_of_mass");
    if (const double alignment = mean_axis_alignment(bed); std::isfinite(alignment)) add("mean_axis_alignment", "1", alignment, "tube.axis_alignment");
    add("pellets_counted", "1", count, "tube.pellets_counted");
    add("mean_equivalent_diameter", "mm", mean_diameter / millimetre, "tube.pellets_counted");

    Frame grounded = frame;
    for (Vec3& position : grounded.positions) position.z() -= tube.floor;
    const detail::BedInstant inside{header, grounded, tube, bed.shapes, bed.bodies, mean_diameter, h95, h_grid};
    if (!detail::add_clipped_packing(result, inside)) {
        PackingProfiles profiles = packing_profiles(bed, h95, mean_diameter);
        result.profiles = {std::move(profiles.axial), std::move(profiles.radial)};
    }
    detail::add_orientation(result, inside);
    if (tube.overlaps) detail::add_overlaps(result, inside);
    return result;
}

}  // namespace pelletlab::observables
