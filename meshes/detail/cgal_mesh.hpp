// Between TriangleMesh and CGAL's surface mesh; for *_cgal.cpp files only, which include CGAL first.
#pragma once

#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Fails (returns false) when CGAL cannot link a triangle to its neighbours.
template <class SurfaceMesh>
bool to_cgal(const TriangleMesh& mesh, SurfaceMesh& result) {
    std::vector<typename SurfaceMesh::Vertex_index> vertices;
    vertices.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) vertices.push_back(result.add_vertex(typename SurfaceMesh::Point(v.x(), v.y(), v.z())));
    for (const Triangle& t : mesh.faces)
        if (result.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) == SurfaceMesh::null_face()) return false;
    return true;
}

template <class SurfaceMesh>
TriangleMesh from_cgal(const SurfaceMesh& surface) {
    TriangleMesh mesh;
    std::vector<std::uint32_t> number(surface.num_vertices() + surface.number_of_removed_vertices(), 0);
    for (const auto vertex : surface.vertices()) {
        number[vertex.idx()] = static_cast<std::uint32_t>(mesh.vertices.size());
        const auto& p = surface.point(vertex);
        mesh.vertices.emplace_back(p.x(), p.y(), p.z());
    }
    for (const auto face : surface.faces()) {
        const auto h = surface.halfedge(face);
        const auto at = [&](auto side) { return number[surface.target(side).idx()]; };
        mesh.faces.push_back({at(surface.prev(h)), at(h), at(surface.next(h))});
    }
    return mesh;
}

}  // namespace pelletlab::meshes::detail
