#include "observables/detail/convex_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace pelletlab::observables::detail {

namespace {

constexpr double same_normal = 1e-10;  // 1 − cosine
constexpr double same_plane = 1e-6;    // of the body's size
constexpr double straight = 1e-8;      // of the size squared: cross product of two edges that are one
constexpr double infinity = std::numeric_limits<double>::infinity();

double highest_along(const ConvexBody& body, const Vec3& n) {
    double highest = -infinity;
    for (const Vec3& vertex : body.vertices) highest = std::max(highest, vertex.dot(n));
    return highest;
}

/// Displacement along n that parts the bodies; negative when they are apart along it.
double overlap_along(const ConvexBody& a, const ConvexBody& b, const Vec3& n) {
    return highest_along(a, n) + highest_along(b, -n);
}

/// Convex hull of the points of one plane in counter-clockwise order about `normal` (Andrew's monotone chain); points on its edges are left out.
std::vector<std::uint32_t> hull_in_plane(const std::vector<Vec3>& points, std::vector<std::uint32_t> of, const Vec3& normal, double slack) {
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const auto x = [&](std::uint32_t i) { return points[i].dot(u); };
    const auto y = [&](std::uint32_t i) { return points[i].dot(v); };
    std::sort(of.begin(), of.end(), [&](std::uint32_t i, std::uint32_t k) { return std::pair(x(i), y(i)) < std::pair(x(k), y(k)); });
    const auto turn = [&](std::uint32_t o, std::uint32_t a, std::uint32_t b) { return (x(a) - x(o)) * (y(b) - y(o)) - (y(a) - y(o)) * (x(b) - x(o)); };
    std::vector<std::uint32_t> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t begin = hull.size();
        for (const std::uint32_t i : of) {
            while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), i) <= slack) hull.pop_back();
            hull.push_back(i);
        }
        hull.pop_back();  // the other side begins with it
        std::reverse(of.begin(), of.end());
    }
    return hull;
}

/// Adds a third of area · distance of the parts of a's faces inside b; `from` is any point. A face that lies in a face of b counts only when both look the same
/// way (bodies that only touch have no volume in common), and only when `shared`; rounding must not decide that.
double faces_inside(const ConvexBody& a, const ConvexBody& b, const Vec3& from, bool shared) {
    double sum = 0.0, size = 0.0;
    for (const Vec3& vertex : b.vertices) size = std::max(size, (vertex - b.centre).squaredNorm());
    const double slack = same_plane * std::sqrt(size);
    // Faces on the far side of a never reach b.
    const Vec3 towards = b.centre - a.centre;
    const double nearest_of_b = -highest_along(b, -towards);
    std::vector<Vec3> polygon, part;
    for (const ConvexBody::Face& face : a.faces) {
        if (std::all_of(face.corners.begin(), face.corners.end(), [&](std::uint32_t corner) { return a.vertices[corner].dot(towards) < nearest_of_b; }))
            continue;
        polygon.clear();
        for (const std::uint32_t corner : face.corners) polygon.push_back(a.vertices[corner]);
        for (const ConvexBody::Face& plane : b.faces) {
            bool all_inside = true, all_outside = true;
            const double along = plane.normal.dot(face.normal);
            double offset = plane.offset;
            if (along > 1.0 - same_normal)
                offset += shared ? slack : -slack;
            else if (along < same_normal - 1.0)
                offset -= slack;
            for (const Vec3& p : polygon) (p.dot(plane.normal) > offset ? all_inside : all_outside) = false;
            if (all_outside) {
                polygon.clear();
                break;
            }
            if (all_inside) continue;
            part.clear();
            for (std::size_t k = 0; k < polygon.size(); ++k) {
                const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
                const double hp = offset - p.dot(plane.normal), hq = offset - q.dot(plane.normal);
                if (hp >= 0.0) part.push_back(p);
                if ((hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0)) part.push_back(p + (q - p) * (hp / (hp - hq)));
            }
            polygon.swap(part);
            if (polygon.size() < 3) break;
        }
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) sum += (polygon[0] - from).dot((polygon[k] - from).cross(polygon[k + 1] - from)) / 6.0;
    }
    return sum;
}

/// Walks downhill on the sphere of directions from `best` in steps halved from `step`.
double least_overlap_near(const ConvexBody& a, const ConvexBody& b, Vec3 best, double step, double largest_gap) {
    double least = overlap_along(a, b, best);
    while (step > 1e-4 && least >= -largest_gap) {
        const Vec3 u = best.unitOrthogonal(), v = best.cross(u);
        const double before = least;
        Vec3 better = best;
        for (int k = 0; k < 8 && least >= -largest_gap; ++k) {
            const double angle = 0.25 * std::numbers::pi * k;
            const Vec3 n = (best + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
            if (const double overlap = overlap_along(a, b, n); overlap < least) {
                least = overlap;
                better = n;
            }
        }
        best = better;
        if (!(least < before)) step *= 0.5;
    }
    return least;
}

}  // namespace

bool is_convex(const TriangleMesh& mesh, double slack) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 a = mesh.corner(f, 0), normal = (mesh.corner(f, 1) - a).cross(mesh.corner(f, 2) - a);
        if (!(normal.norm() > 0.0)) continue;
        for (const Vec3& vertex : mesh.vertices)
            if ((vertex - a).dot(normal) > slack * normal.norm()) return false;
    }
    return !mesh.faces.empty();
}

ConvexBody convex_body(const TriangleMesh& mesh) {
    ConvexBody body;
    double size = 0.0;
    for (const Vec3& vertex : mesh.vertices) {
        body.centre += vertex / static_cast<double>(mesh.vertices.size());
        size = std::max(size, vertex.norm());
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 a = mesh.corner(f, 0);
        Vec3 normal = (mesh.corner(f, 1) - a).cross(mesh.corner(f, 2) - a);
        if (!(normal.norm() > 0.0)) continue;
        normal.normalize();
        const double offset = normal.dot(a);
        const bool known = std::any_of(body.faces.begin(), body.faces.end(), [&](const ConvexBody::Face& face) {
            return face.normal.dot(normal) > 1.0 - same_normal && std::abs(face.offset - offset) < same_plane * size;
        });
        if (!known) body.faces.push_back({normal, offset, {}});
    }
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_index(mesh.vertices.size(), unused);
    for (ConvexBody::Face& face : body.faces) {
        std::vector<std::uint32_t> on_plane;
        for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
            if (std::abs(mesh.vertices[i].dot(face.normal) - face.offset) < same_plane * size) on_plane.push_back(i);
        for (const std::uint32_t i : hull_in_plane(mesh.vertices, std::move(on_plane), face.normal, straight * size * size)) {
            if (new_index[i] == unused) {
                new_index[i] = static_cast<std::uint32_t>(body.vertices.size());
                body.vertices.push_back(mesh.vertices[i]);
            }
            face.corners.push_back(new_index[i]);
        }
    }
    return body;
}

ConvexBody moved(const ConvexBody& body, const Pose& pose) {
    ConvexBody result = body;
    const Mat3 rotation = pose.orientation.toRotationMatrix();
    for (Vec3& vertex : result.vertices) vertex = rotation * vertex + pose.position;
    for (ConvexBody::Face& face : result.faces) {
        face.normal = rotation * face.normal;
        face.offset += face.normal.dot(pose.position);
    }
    result.centre = rotation * body.centre + pose.position;
    return result;
}

double penetration(const ConvexBody& a, const ConvexBody& b, double largest_gap) {
    Vec3 start = b.centre - a.centre;
    if (!(start.norm() > 0.0)) start = Vec3::UnitZ();
    start.normalize();
    const double least = least_overlap_near(a, b, start, 0.5, largest_gap);
    if (!(least > 0.0)) return least;
    double least_of_normals = infinity;
    Vec3 best = start;
    const auto offer = [&](const Vec3& n) {
        if (n.dot(start) <= 0.0) return;
        if (const double overlap = overlap_along(a, b, n); overlap < least_of_normals) {
            least_of_normals = overlap;
            best = n;
        }
    };
    for (const ConvexBody::Face& face : a.faces) offer(face.normal);
    for (const ConvexBody::Face& face : b.faces) offer(-face.normal);
    return std::min(least, least_overlap_near(a, b, best, 0.05, largest_gap));
}

double common_volume(const ConvexBody& a, const ConvexBody& b) {
    const Vec3 from = 0.5 * (a.centre + b.centre);  // any point will do: the parts of both surfaces close
    return faces_inside(a, b, from, true) + faces_inside(b, a, from, false);
}

}  // namespace pelletlab::observables::detail
