#include "solver/exact_surface.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "solver/detail/exact_surface_hits.hpp"

namespace pelletlab::solver {

ExactSurface exact_plane(const Vec3& point, const Vec3& normal) {
    ExactSurface s;  // the other members keep their zeros: {} would leave vectors of Eigen as memory was
    s.kind = ExactSurface::Kind::plane, s.point = point, s.axis = normal.normalized();
    return s;
}

ExactSurface exact_cone(const Vec3& point, const Vec3& axis, double low_radius, double low, double high_radius, double high) {
    return {ExactSurface::Kind::revolved, point, axis.normalized(), {low_radius, low}, {high_radius, high}, Vec3::Zero()};
}

ExactSurface exact_cylinder(const Vec3& point, const Vec3& axis, double radius, double low, double high) {
    return exact_cone(point, axis, radius, low, radius, high);
}

ExactSurface exact_disc(const Vec3& point, const Vec3& axis, double radius) {
    return exact_cone(point, axis, 0.0, 0.0, radius, 0.0);
}

ExactSurface exact_box(const Vec3& low, const Vec3& high) {
    return {ExactSurface::Kind::box, 0.5 * (low + high), Vec3::UnitZ(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), 0.5 * (high - low)};
}

namespace detail {

namespace {

Hit hit_at(const Vec3& point, const Vec3& centre, std::uint32_t patch) {
    return {point, (centre - point).squaredNorm(), patch, FeatureKind::face, 0};
}

/// In the half plane (distance from the axis, height along it) the surface is a segment.
Hit revolved_hit(const ExactSurface& s, const Vec3& centre) {
    const Vec3 from = centre - s.point;
    const double height = from.dot(s.axis);
    const Vec3 across = from - s.axis * height;
    const double rho = across.norm();
    const Vec3 outward = rho > 0.0 ? Vec3(across / rho) : s.axis.unitOrthogonal();
    const Eigen::Vector2d along = s.end - s.start, here(rho, height);
    const Eigen::Vector2d nearest = s.start + along * std::clamp((here - s.start).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return hit_at(s.point + s.axis * nearest.y() + outward * nearest.x(), centre, 0);
}

bool inside_box(const ExactSurface& s, const Vec3& from) {
    return (s.half_size - from.cwiseAbs()).minCoeff() > 0.0;
}

}  // namespace

double distance_to(const ExactSurface& s, const Vec3& centre) {
    if (s.kind == ExactSurface::Kind::plane) return std::abs((centre - s.point).dot(s.axis));
    if (s.kind == ExactSurface::Kind::revolved) return std::sqrt(revolved_hit(s, centre).distance2);
    const Vec3 from = centre - s.point;
    if (inside_box(s, from)) return (s.half_size - from.cwiseAbs()).minCoeff();
    return (from.cwiseAbs() - s.half_size).cwiseMax(0.0).norm();
}

void exact_hits(const ExactSurface& s, const Vec3& centre, double radius, std::vector<Hit>& hits) {
    const Vec3 from = centre - s.point;
    const auto add = [&](const Hit& hit) {
        if (hit.distance2 < radius * radius) hits.push_back(hit);
    };
    if (s.kind == ExactSurface::Kind::plane) return add(hit_at(centre - s.axis * from.dot(s.axis), centre, 0));
    if (s.kind == ExactSurface::Kind::revolved) return add(revolved_hit(s, centre));
    if (!inside_box(s, from)) return add(hit_at(s.point + from.cwiseMax(-s.half_size).cwiseMin(s.half_size), centre, 0));
    for (int k = 0; k < 3; ++k)
        for (const double side : {-1.0, 1.0}) {
            Vec3 foot = centre;
            foot[k] = s.point[k] + side * s.half_size[k];
            add(hit_at(foot, centre, static_cast<std::uint32_t>(2 * k + (side > 0.0 ? 1 : 0))));
        }
}

void check_surface(const ExactSurface& s, const std::string& wall) {
    const bool finite = s.point.allFinite() && s.axis.allFinite() && s.start.allFinite() && s.end.allFinite() && s.half_size.allFinite();
    const bool has_extent = s.kind == ExactSurface::Kind::plane ||
                            (s.kind == ExactSurface::Kind::revolved && (s.end - s.start).norm() > 0.0 && s.start.x() >= 0.0 && s.end.x() >= 0.0) ||
                            (s.kind == ExactSurface::Kind::box && s.half_size.minCoeff() > 0.0);
    if (!finite || !has_extent || std::abs(s.axis.norm() - 1.0) > 1e-9)
        throw bad_input("wall «" + wall + "»: its exact surface has no extent, a negative radius, or a number that is not finite", "correct its measures");
}

}  // namespace detail

}  // namespace pelletlab::solver
