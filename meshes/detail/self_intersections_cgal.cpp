#include <CGAL/Bbox_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>

#include "meshes/detail/clean.hpp"
#include "meshes/detail/self_intersections.hpp"

namespace pelletlab::meshes::detail {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

/// The triangle's corners, those shared with the other triangle first.
struct Arranged {
    std::array<std::uint32_t, 3> corner{};
    int shared = 0;
};

Arranged arrange(const Triangle& t, const Triangle& other) {
    Arranged result;
    const auto is_shared = [&](std::uint32_t v) { return std::find(other.begin(), other.end(), v) != other.end(); };
    std::size_t place = 0;
    for (const std::uint32_t v : t)
        if (is_shared(v)) {
            result.corner[place++] = v;
            ++result.shared;
        }
    for (const std::uint32_t v : t)
        if (!is_shared(v)) result.corner[place++] = v;
    return result;
}

bool cross(const std::vector<Point>& points, const Triangle& t, const Triangle& u) {
    const Arranged a = arrange(t, u), b = arrange(u, t);
    const auto p = [&](const Arranged& x, std::size_t k) -> const Point& { return points[x.corner[k]]; };
    switch (a.shared) {
        case 0:
            return CGAL::do_intersect(Kernel::Triangle_3(p(a, 0), p(a, 1), p(a, 2)), Kernel::Triangle_3(p(b, 0), p(b, 1), p(b, 2)));
        case 1:
            return CGAL::do_intersect(Kernel::Triangle_3(p(a, 0), p(a, 1), p(a, 2)), Kernel::Segment_3(p(b, 1), p(b, 2))) ||
                   CGAL::do_intersect(Kernel::Triangle_3(p(b, 0), p(b, 1), p(b, 2)), Kernel::Segment_3(p(a, 1), p(a, 2)));
        case 2:  // folded flat onto each other: in one plane and on the same side of the common edge
            return CGAL::coplanar(p(a, 0), p(a, 1), p(a, 2), p(b, 2)) && CGAL::coplanar_orientation(p(a, 0), p(a, 1), p(a, 2), p(b, 2)) == CGAL::POSITIVE;
        default:
            return false;
    }
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(const TriangleMesh& mesh) {
    std::vector<Point> points;
    points.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
    std::vector<Box> boxes;
    boxes.reserve(mesh.faces.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const Triangle& t = mesh.faces[f];
        const Point &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
        if (is_degenerate(mesh, t) || CGAL::collinear(a, b, c)) continue;
        boxes.emplace_back(a.bbox() + b.bbox() + c.bbox(), f);
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
        if (cross(points, mesh.faces[x.info()], mesh.faces[y.info()])) pairs.push_back(std::minmax(x.info(), y.info()));
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace pelletlab::meshes::detail
