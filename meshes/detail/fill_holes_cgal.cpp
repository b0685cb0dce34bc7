#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <map>

#include "meshes/detail/surgery.hpp"
#include "meshes/detail/topology.hpp"

namespace pelletlab::meshes::detail {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Loops of boundary vertices; each runs so that a patch that follows it agrees with the surface around.
std::vector<std::vector<std::uint32_t>> boundary_loops(const TriangleMesh& mesh) {
    std::multimap<std::uint32_t, std::uint32_t> next;  // a patch has each boundary side the other way round
    for_each_edge(sorted_half_edges(mesh), [&](const HalfEdge* begin, const HalfEdge* end) {
        if (end - begin != 1) return;
        next.emplace(begin->forward ? begin->high : begin->low, begin->forward ? begin->low : begin->high);
    });
    std::vector<std::vector<std::uint32_t>> loops;
    while (!next.empty()) {
        std::vector<std::uint32_t> path{next.begin()->first};
        // Where several holes touch in a vertex the path closes a loop as soon as it comes back to any of its vertices.
        while (true) {
            const auto step = next.find(path.back());
            if (step == next.end()) break;
            const std::uint32_t to = step->second;
            next.erase(step);
            const auto seen = std::find(path.begin(), path.end(), to);
            if (seen == path.end()) {
                path.push_back(to);
                continue;
            }
            loops.emplace_back(seen, path.end());
            path.erase(seen + 1, path.end());
        }
    }
    return loops;
}

}  // namespace

FilledMesh fill_holes(const TriangleMesh& mesh) {
    FilledMesh result{mesh, 0, 0, 0.0};
    for (const std::vector<std::uint32_t>& loop : boundary_loops(mesh)) {
        std::vector<Kernel::Point_3> points;
        double perimeter = 0.0;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec3& v = mesh.vertices[loop[k]];
            points.emplace_back(v.x(), v.y(), v.z());
            perimeter += (mesh.vertices[loop[(k + 1) % loop.size()]] - v).norm();
        }
        std::vector<CGAL::Triple<int, int, int>> patch;
        if (loop.size() >= 3) CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(patch));
        if (patch.empty()) {
            ++result.holes_left;
            continue;
        }
        for (const auto& t : patch)
            result.mesh.faces.push_back(
                {loop[static_cast<std::size_t>(t.first)], loop[static_cast<std::size_t>(t.second)], loop[static_cast<std::size_t>(t.third)]});
        ++result.holes;
        result.largest_perimeter = std::max(result.largest_perimeter, perimeter);
    }
    orient_consistently(result.mesh);
    return result;
}

}  // namespace pelletlab::meshes::detail
