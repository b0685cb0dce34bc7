// Signed distance to the outer surface of a union of spheres, exact on both sides: negative inside, positive outside.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shapegen/detail/outer_surface.hpp"
#include "shapegen/detail/union_boundary.hpp"

namespace pelletlab::shapegen::detail {

/// Outside: min |p − c| − r. Inside: the nearest point is a radial projection onto an exposed part, or lies on an exposed arc.
class UnionDistance {
public:
    UnionDistance(std::span<const Sphere> spheres, std::span<const ExposedPart> boundary, const OuterSurface& outer);

    double value(const Vec3& p) const;

    /// |p − c| − r of the sphere that gives the least, and which one it is: the signed distance outside, a bound of it inside.
    double nearest_sphere(const Vec3& p, std::uint32_t& which) const;

private:
    struct Arc {
        ExposedArc circle;
        Vec3 middle;         // of a ball around the arc
        double reach = 0.0;  // its radius
    };

    double depth(const Vec3& p) const;
    bool exposed(const Vec3& q, std::uint32_t owner) const;

    std::span<const Sphere> spheres_;
    std::span<const ExposedPart> boundary_;
    const OuterSurface& outer_;
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<Arc> arcs_;  // outer ones, each once
};

/// Points spread over the outer exposed surface, about one per spacing²; the weights of a sphere's points add up to its exposed area.
struct UnionSamples {
    std::vector<Vec3> points, normals;
    std::vector<double> areas;         ///< [m²], one a point
    std::vector<std::uint32_t> owner;  ///< sphere of the point
};

UnionSamples sample_union(std::span<const Sphere> spheres, std::span<const ExposedPart> boundary, const OuterSurface& outer, double spacing);

}  // namespace pelletlab::shapegen::detail
