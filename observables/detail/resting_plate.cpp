#include "observables/detail/resting_plate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pelletlab::observables::detail {

namespace {

using Triangle3 = std::array<Vec3, 3>;

constexpr int most_pivots = 2000;                         // some tens are usual
constexpr double far_away = 1e3;                          // plate radii: the three points that the search begins with, which no bed has
constexpr double enclosed = -1e-12;                       // smallest weight of a corner that still counts as enclosing
constexpr double beside_x = 1.0e-6, beside_y = 0.618e-6;  // plate radii, of the weight from the axis: pellets in rows would let the search go in circles

struct Plane {
    double a, b, c;  ///< z = a + b x + c y
    double above(const Vec3& p) const { return p.z() - (a + b * p.x() + c * p.y()); }
};

double cross2(const Vec3& p, const Vec3& q) {
    return p.x() * q.y() - p.y() * q.x();
}

/// Weights of the corners whose mean is the axis; the smallest one tells whether the triangle encloses it.
double smallest_weight(const Triangle3& t) {
    const double area = cross2(t[1] - t[0], t[2] - t[0]);
    if (area == 0.0) return -1.0;
    return std::min({cross2(t[1], t[2]) / area, cross2(t[2], t[0]) / area, cross2(t[0], t[1]) / area});
}

Plane plane_through(const Triangle3& t) {
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double b = -normal.x() / normal.z(), c = -normal.y() / normal.z();
    return {t[0].z() - b * t[0].x() - c * t[0].y(), b, c};
}

/// The point of a pellet that reaches furthest along `normal`, in the world.
Vec3 furthest_point(const PelletShape& shape, const Pose& pose, const Vec3& normal) {
    const Vec3 along = pose.orientation.conjugate() * normal;
    Vec3 best = Vec3::Zero();
    double furthest = -std::numeric_limits<double>::infinity();
    const auto offer = [&](const Vec3& point) {
        const double reach = point.dot(along);
        if (reach > furthest) furthest = reach, best = point;
    };
    for (const Vec3& vertex : shape.surface_body.vertices) offer(vertex);
    if (shape.surface_body.vertices.empty())
        for (const Sphere& sphere : shape.rigid.spheres) offer(sphere.centre + sphere.radius * along);
    return pose.to_world(best);
}

}  // namespace

RestingPlate resting_plate(const TrajectoryHeader& header, const Frame& frame, const std::vector<std::size_t>& bodies, double radius) {
    if (bodies.empty()) return {};
    const Vec3 middle = radius * Vec3(beside_x, beside_y, 0.0);
    std::vector<double> reach_of;  // of each shape's surface or spheres from its centre of mass
    for (const PelletShape& shape : header.shapes) {
        reach_of.push_back(shape.rigid.bounding_radius);
        for (const Vec3& vertex : shape.surface_body.vertices) reach_of.back() = std::max(reach_of.back(), vertex.norm());
    }
    double lowest = std::numeric_limits<double>::infinity();
    for (const std::size_t body : bodies) lowest = std::min(lowest, frame.positions[body].z());
    const double out = far_away * radius, below = lowest - out;
    Triangle3 corners{Vec3(out, 0.0, below), Vec3(-0.5 * out, 0.8 * out, below), Vec3(-0.5 * out, -0.8 * out, below)};
    std::array<bool, 3> real{false, false, false};
    for (int pivot = 0; pivot < most_pivots; ++pivot) {
        const Plane plane = plane_through(corners);
        const double slope = std::sqrt(1.0 + plane.b * plane.b + plane.c * plane.c);
        const Vec3 normal = Vec3(-plane.b, -plane.c, 1.0) / slope;
        Vec3 highest = Vec3::Zero();
        double through = 1e-9 * radius;
        bool found = false;
        for (const std::size_t body : bodies) {
            const Vec3 centre = frame.positions[body] - middle;
            const std::uint32_t shape = header.shape_of_body[body];
            if (plane.above(centre) + reach_of[shape] * slope <= through) continue;
            const Vec3 point = furthest_point(header.shapes[shape], {centre, frame.orientations[body]}, normal);
            if (const double reach = plane.above(point); reach > through) through = reach, highest = point, found = true;
        }
        if (!found) {
            if (!(real[0] && real[1] && real[2])) return {};
            return {plane.a, std::atan(std::hypot(plane.b, plane.c))};
        }
        std::size_t replaced = 0;
        double best = -2.0;
        for (std::size_t k = 0; k < 3; ++k) {
            Triangle3 next = corners;
            next[k] = highest;
            if (const double weight = smallest_weight(next); weight > best) best = weight, replaced = k;
        }
        if (best < enclosed) return {};
        corners[replaced] = highest;
        real[replaced] = true;
    }
    return {};
}

}  // namespace pelletlab::observables::detail
