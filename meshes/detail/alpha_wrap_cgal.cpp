#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "meshes/detail/cgal_mesh.hpp"
#include "meshes/detail/surgery.hpp"

namespace pelletlab::meshes::detail {

TriangleMesh alpha_wrap(const TriangleMesh& mesh, double alpha, double offset) {
    using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
    std::vector<Point> points;
    points.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
    std::vector<std::array<std::size_t, 3>> faces;
    faces.reserve(mesh.faces.size());
    for (const Triangle& t : mesh.faces) faces.push_back({t[0], t[1], t[2]});
    CGAL::Surface_mesh<Point> wrap;
    CGAL::alpha_wrap_3(points, faces, alpha, offset, wrap);
    return from_cgal(wrap);
}

}  // namespace pelletlab::meshes::detail
