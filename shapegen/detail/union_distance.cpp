#include "shapegen/detail/union_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr double pi = std::numbers::pi;

Vec3 arc_position(const ExposedArc& arc, const Sphere& sphere, double t) {
    return sphere.centre + sphere.radius * (arc.cos_opening * arc.axis + arc.sin_opening * (arc.u * std::cos(t) + arc.v * std::sin(t)));
}

double distance_to_arc(const Vec3& p, const ExposedArc& arc, const Sphere& sphere) {
    const Vec3 x = p - sphere.centre - sphere.radius * arc.cos_opening * arc.axis;
    const double a = x.dot(arc.u), b = x.dot(arc.v), h = x.dot(arc.axis);
    const double circle = sphere.radius * arc.sin_opening;
    double t = std::atan2(b, a);
    t += 2.0 * pi * std::ceil((arc.begin - t) / (2.0 * pi));  // first such angle ≥ begin
    if (t <= arc.end) return std::hypot(std::hypot(a, b) - circle, h);
    return std::min((p - arc_position(arc, sphere, arc.begin)).norm(), (p - arc_position(arc, sphere, arc.end)).norm());
}

}  // namespace

UnionDistance::UnionDistance(std::span<const Sphere> spheres, std::span<const ExposedPart> boundary, const OuterSurface& outer)
    : spheres_(spheres), boundary_(boundary), outer_(outer), neighbours_(overlapping_neighbours(spheres)) {
    for (const ExposedPart& part : boundary) {
        for (const ExposedArc& arc : part.arcs) {
            // The other sphere holds the same arc, except where three spheres share a circle.
            const auto same = [&](const ExposedArc& other) { return other.neighbour == arc.sphere; };
            const auto& others = boundary[arc.neighbour].arcs;
            if (arc.neighbour < arc.sphere && std::any_of(others.begin(), others.end(), same)) continue;
            const Sphere& sphere = spheres[arc.sphere];
            const double half = 0.5 * (arc.end - arc.begin), middle = 0.5 * (arc.begin + arc.end);
            const Vec3 midpoint = arc_position(arc, sphere, middle);
            bool reached = false;  // a narrow crevice may hide a part of the arc from the cells
            for (int k = -2; k <= 2; ++k) reached = reached || outer.reaches(arc_position(arc, sphere, middle + 0.5 * k * half));
            if (!reached) continue;
            const double circle = sphere.radius * arc.sin_opening;
            if (half >= 0.5 * pi) {
                arcs_.push_back({arc, sphere.centre + sphere.radius * arc.cos_opening * arc.axis, circle});
            } else {
                arcs_.push_back({arc, midpoint, 2.0 * circle * std::sin(0.5 * half)});
            }
        }
    }
}

double UnionDistance::nearest_sphere(const Vec3& p, std::uint32_t& which) const {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spheres_.size(); ++i) {
        const double reach = best + spheres_[i].radius;
        const double squared = (p - spheres_[i].centre).squaredNorm();
        if (reach <= 0.0 || squared >= reach * reach) continue;
        best = std::sqrt(squared) - spheres_[i].radius;
        which = static_cast<std::uint32_t>(i);
    }
    return best;
}

double UnionDistance::value(const Vec3& p) const {
    std::uint32_t which = 0;
    const double distance = nearest_sphere(p, which);
    return distance >= 0.0 ? distance : -depth(p);
}

bool UnionDistance::exposed(const Vec3& q, std::uint32_t owner) const {
    for (const std::uint32_t j : neighbours_[owner]) {
        const double r = spheres_[j].radius * (1.0 - 1e-12);
        if ((q - spheres_[j].centre).squaredNorm() < r * r) return false;
    }
    return outer_.reaches(q);
}

double UnionDistance::depth(const Vec3& p) const {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spheres_.size(); ++i) {
        const Sphere& sphere = spheres_[i];
        if (boundary_[i].solid_angle <= 0.0) continue;
        const Vec3 offset = p - sphere.centre;
        const double squared = offset.squaredNorm();
        if (squared >= sphere.radius * sphere.radius || squared == 0.0) continue;
        const double distance = std::sqrt(squared);
        if (sphere.radius - distance >= best) continue;
        if (exposed(sphere.centre + offset * (sphere.radius / distance), static_cast<std::uint32_t>(i))) best = sphere.radius - distance;
    }
    for (const Arc& arc : arcs_) {
        const double reach = best + arc.reach;
        if ((p - arc.middle).squaredNorm() >= reach * reach) continue;
        best = std::min(best, distance_to_arc(p, arc.circle, spheres_[arc.circle.sphere]));
    }
    if (!std::isfinite(best)) {  // p is the centre of the only sphere
        for (std::size_t i = 0; i < spheres_.size(); ++i) {
            if ((p - spheres_[i].centre).norm() < spheres_[i].radius) best = std::min(best, spheres_[i].radius);
        }
    }
    return best;
}

UnionSamples sample_union(std::span<const Sphere> spheres, std::span<const ExposedPart> boundary, const OuterSurface& outer, double spacing) {
    const auto neighbours = overlapping_neighbours(spheres);
    std::vector<UnionSamples> part(spheres.size());
    parallel_for(spheres.size(), 4, [&](std::size_t i) {
        const double solid_angle = boundary[i].solid_angle;
        if (solid_angle <= 0.0) return;
        const Sphere& sphere = spheres[i];
        // Fibonacci points; enough of them that a small exposed part gets some as well. Which neighbours cover one point is mostly what covered the last.
        const double area = 4.0 * pi * sphere.radius * sphere.radius;
        const double wanted = std::max(area / (spacing * spacing), std::min(20000.0, 40.0 * 4.0 * pi / solid_angle));
        const std::size_t n = static_cast<std::size_t>(std::ceil(wanted));
        std::vector<std::uint32_t> order = neighbours[i];
        UnionSamples& mine = part[i];
        std::size_t shown = 0;
        for (std::size_t k = 0; k < n; ++k) {
            const double z = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(n);
            const double turn = (static_cast<double>(k) + 0.5) * pi * (3.0 - std::sqrt(5.0));
            const double ring = std::sqrt(1.0 - z * z);
            const Vec3 normal(ring * std::cos(turn), ring * std::sin(turn), z);
            const Vec3 point = sphere.centre + sphere.radius * normal;
            bool covered = false;
            for (std::size_t m = 0; m < order.size(); ++m) {
                const double r = spheres[order[m]].radius * (1.0 - 1e-12);
                if ((point - spheres[order[m]].centre).squaredNorm() < r * r) {
                    covered = true;
                    if (m > 0) std::swap(order[m], order[m / 2]);
                    break;
                }
            }
            if (covered) continue;
            ++shown;
            if (!outer.reaches(point)) continue;
            mine.points.push_back(point);
            mine.normals.push_back(normal);
        }
        const double each = shown == 0 ? 0.0 : solid_angle * sphere.radius * sphere.radius / static_cast<double>(shown);
        mine.areas.assign(mine.points.size(), each);
        mine.owner.assign(mine.points.size(), static_cast<std::uint32_t>(i));
    });
    UnionSamples all;
    for (const UnionSamples& mine : part) {
        all.points.insert(all.points.end(), mine.points.begin(), mine.points.end());
        all.normals.insert(all.normals.end(), mine.normals.begin(), mine.normals.end());
        all.areas.insert(all.areas.end(), mine.areas.begin(), mine.areas.end());
        all.owner.insert(all.owner.end(), mine.owner.begin(), mine.owner.end());
    }
    return all;
}

}  // namespace pelletlab::shapegen::detail
