#include "observables/detail/convex_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pelletlab::observables::detail {

namespace {

/// Displacement along n that parts the bodies; negative when they are apart along it.
double overlap_along(const ConvexBody& a, const ConvexBody& b, const Vec3& n) {
    double furthest = -1e300, nearest = 1e300;
    for (const Vec3& vertex : a.vertices) furthest = std::max(furthest, vertex.dot(n));
    for (const Vec3& vertex : b.vertices) nearest = std::min(nearest, vertex.dot(n));
    return furthest - nearest;
}

/// Adds a third of area · distance of the parts of a's faces inside b; `from` is any point.
double faces_inside(const ConvexBody& a, const ConvexBody& b, const Vec3& from) {
    double sum = 0.0;
    std::vector<Vec3> polygon, part;
    for (const Triangle& face : a.faces) {
        polygon.assign({a.vertices[face[0]], a.vertices[face[1]], a.vertices[face[2]]});
        for (const ConvexBody::Plane& plane : b.planes) {
            bool all_inside = true, all_outside = true;
            for (const Vec3& p : polygon) (p.dot(plane.normal) > plane.offset ? all_inside : all_outside) = false;
            if (all_outside) polygon.clear();
            if (polygon.empty()) break;
            if (all_inside) continue;
            part.clear();
            for (std::size_t k = 0; k < polygon.size(); ++k) {
                const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
                const double hp = plane.offset - p.dot(plane.normal), hq = plane.offset - q.dot(plane.normal);
                if (hp >= 0.0) part.push_back(p);
                if ((hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0)) part.push_back(p + (q - p) * (hp / (hp - hq)));
            }
            polygon.swap(part);
        }
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) sum += (polygon[0] - from).dot((polygon[k] - from).cross(polygon[k + 1] - from)) / 6.0;
    }
    return sum;
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
    ConvexBody body{mesh.vertices, mesh.faces, {}, Vec3::Zero()};
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
        const bool known = std::any_of(body.planes.begin(), body.planes.end(), [&](const ConvexBody::Plane& plane) {
            return plane.normal.dot(normal) > 1.0 - 1e-10 && std::abs(plane.offset - offset) < 1e-6 * size;
        });
        if (!known) body.planes.push_back({normal, offset});
    }
    return body;
}

ConvexBody moved(const ConvexBody& body, const Pose& pose) {
    ConvexBody result = body;
    const Mat3 rotation = pose.orientation.toRotationMatrix();
    for (Vec3& vertex : result.vertices) vertex = rotation * vertex + pose.position;
    for (ConvexBody::Plane& plane : result.planes) {
        plane.normal = rotation * plane.normal;
        plane.offset += plane.normal.dot(pose.position);
    }
    result.centre = rotation * body.centre + pose.position;
    return result;
}

double penetration(const ConvexBody& a, const ConvexBody& b, double largest_gap) {
    Vec3 best = b.centre - a.centre;
    if (!(best.norm() > 0.0)) best = Vec3::UnitZ();
    best.normalize();
    double least = overlap_along(a, b, best);
    for (double step = 0.5; step > 1e-4 && least >= -largest_gap;) {
        const Vec3 u = best.unitOrthogonal(), v = best.cross(u);
        const double before = least;
        Vec3 better = best;
        for (int k = 0; k < 8 && least >= -largest_gap; ++k) {
            const double angle = 0.25 * 3.14159265358979323846 * k;
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

double common_volume(const ConvexBody& a, const ConvexBody& b) {
    const Vec3 from = 0.5 * (a.centre + b.centre);  // any point will do: the parts of both surfaces close
    return faces_inside(a, b, from) + faces_inside(b, a, from);
}

}  // namespace pelletlab::observables::detail
