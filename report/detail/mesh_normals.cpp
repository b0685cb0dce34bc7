#include <algorithm>
#include <cmath>
#include <map>

#include "report/detail/prepared_scene.hpp"

namespace pelletlab::report::detail {
namespace {

Vec3 area_normal(const TriangleMesh& mesh, std::size_t face) {
    const Vec3 a = mesh.corner(face, 0);
    return (mesh.corner(face, 1) - a).cross(mesh.corner(face, 2) - a);
}

/// Zero for a triangle without area, which then has no say in any mean.
std::vector<Vec3> unit_normals(const TriangleMesh& mesh) {
    std::vector<Vec3> normals(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 n = area_normal(mesh, f);
        const double length = n.norm();
        normals[f] = length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero());
    }
    return normals;
}

double corner_angle(const TriangleMesh& mesh, std::size_t face, int k) {
    const Vec3 here = mesh.corner(face, k);
    const Vec3 next = mesh.corner(face, (k + 1) % 3) - here, before = mesh.corner(face, (k + 2) % 3) - here;
    return std::atan2(next.cross(before).norm(), next.dot(before));
}

}  // namespace

std::vector<std::array<Vec3f, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle) {
    struct Corner {
        std::uint32_t face;
        double angle;
    };
    std::vector<std::vector<Corner>> corners_of_vertex(mesh.vertices.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) corners_of_vertex[mesh.faces[f][static_cast<std::size_t>(k)]].push_back({f, corner_angle(mesh, f, k)});

    const std::vector<Vec3> normals = unit_normals(mesh);
    const double flattest = std::cos(crease_angle);
    std::vector<std::array<Vec3f, 3>> result(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3 sum = Vec3::Zero();
            for (const Corner& corner : corners_of_vertex[mesh.faces[f][k]])
                if (normals[corner.face].dot(normals[f]) >= flattest) sum += corner.angle * normals[corner.face];
            const double length = sum.norm();
            result[f][k] = (length > 0.0 ? Vec3(sum / length) : normals[f]).cast<float>();
        }
    return result;
}

std::vector<std::array<std::uint32_t, 2>> feature_edges(const TriangleMesh& mesh, double crease_angle) {
    std::map<std::array<std::uint32_t, 2>, std::vector<std::size_t>> faces_of_edge;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]);
            faces_of_edge[{a, b}].push_back(f);
        }
    const std::vector<Vec3> normals = unit_normals(mesh);
    const double flattest = std::cos(crease_angle);
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& [edge, faces] : faces_of_edge)
        if (faces.size() != 2 || normals[faces[0]].dot(normals[faces[1]]) < flattest) edges.push_back(edge);
    return edges;
}

}  // namespace pelletlab::report::detail
