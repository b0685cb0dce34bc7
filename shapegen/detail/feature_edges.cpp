#include "shapegen/detail/feature_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace pelletlab::shapegen::detail {

namespace {

Vec3 face_normal(const TriangleMesh& mesh, std::size_t f) {
    return (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0));
}

}  // namespace

std::vector<Vec3> sharp_edge_points(const TriangleMesh& mesh, double angle, double spacing) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> faces_of_edge;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
            faces_of_edge[{std::min(a, b), std::max(a, b)}].push_back(f);
        }
    }
    std::vector<Vec3> points;
    for (const auto& [edge, faces] : faces_of_edge) {
        if (faces.size() != 2) continue;
        const Vec3 n = face_normal(mesh, faces[0]), m = face_normal(mesh, faces[1]);
        if (std::atan2(n.cross(m).norm(), n.dot(m)) < angle) continue;
        const Vec3 &a = mesh.vertices[edge.first], &b = mesh.vertices[edge.second];
        const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
        for (int k = 0; k <= pieces; ++k) points.push_back(a + (b - a) * (static_cast<double>(k) / pieces));
    }
    return points;
}

void add_edge_points(SurfaceSamples& samples, const TriangleMesh& mesh, double angle, double spacing) {
    std::vector<Vec3> points = sharp_edge_points(mesh, angle, spacing);
    sort_by_place(points, bounding_box(mesh));
    for (const Vec3& p : points) {
        samples.points.push_back(p);
        samples.normals.push_back(Vec3::Zero());
    }
}

std::vector<FlatFace> flat_faces(const TriangleMesh& mesh, double least_share) {
    struct Tile {
        Vec3 normal;
        double level, area;
    };
    std::vector<Tile> tiles;
    double total = 0.0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 n = face_normal(mesh, f);
        const double area = 0.5 * n.norm();
        if (!(area > 0.0)) continue;
        tiles.push_back({n.normalized(), n.normalized().dot(mesh.corner(f, 0)), area});
        total += area;
    }
    // Large triangles first, so that the planes that matter come early; the list is bounded because a curved mesh has a plane a triangle.
    const double size = bounding_box(mesh).diagonal().norm();
    std::sort(tiles.begin(), tiles.end(), [](const Tile& a, const Tile& b) { return a.area > b.area; });
    std::vector<FlatFace> faces;
    for (const Tile& tile : tiles) {
        const auto same = [&](const FlatFace& face) { return face.normal.dot(tile.normal) > 1.0 - 1e-6 && std::abs(face.level - tile.level) < 1e-4 * size; };
        const auto found = std::find_if(faces.begin(), faces.end(), same);
        if (found != faces.end()) {
            found->area += tile.area;
        } else if (faces.size() < 2000) {
            faces.push_back({tile.normal, tile.level, tile.area});
        }
    }
    std::erase_if(faces, [&](const FlatFace& face) { return face.area < least_share * total; });
    std::stable_sort(faces.begin(), faces.end(), [](const FlatFace& a, const FlatFace& b) { return a.area > b.area; });
    return faces;
}

}  // namespace pelletlab::shapegen::detail
