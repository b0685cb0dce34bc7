#include <algorithm>
#include <cmath>
#include <map>

#include "report/detail/sphere_mesh.hpp"
#include "report/pictures.hpp"

namespace pelletlab::report {
namespace detail {
namespace {

TriangleMesh icosahedron() {
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    TriangleMesh mesh;
    mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                     {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.faces = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                  {3, 9, 4},  {3, 4, 2}, {3, 2, 6}, {3, 6, 8},  {3, 8, 9},   {4, 9, 5}, {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (Vec3& vertex : mesh.vertices) vertex.normalize();
    return mesh;
}

/// Finer for few spheres, which show large; at most about a quarter of a million vertices.
int subdivisions_for(std::size_t sphere_count) {
    return sphere_count <= 100 ? 4 : sphere_count <= 400 ? 3 : 2;
}

}  // namespace

TriangleMesh unit_sphere(int subdivisions) {
    TriangleMesh mesh = icosahedron();
    for (int round = 0; round < subdivisions; ++round) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&mesh, &middles](std::uint32_t a, std::uint32_t b) {
            const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (fresh) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
            return at->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle& face : mesh.faces) {
            const std::uint32_t ab = middle(face[0], face[1]), bc = middle(face[1], face[2]), ca = middle(face[2], face[0]);
            finer.insert(finer.end(), {{face[0], ab, ca}, {face[1], bc, ab}, {face[2], ca, bc}, {ab, bc, ca}});
        }
        mesh.faces = std::move(finer);
    }
    return mesh;
}

std::vector<double> cover_depth(std::span<const Sphere> spheres, const TriangleMesh& surfaces) {
    std::vector<double> depth(surfaces.vertices.size(), -std::numeric_limits<double>::infinity());
    const std::size_t each = spheres.empty() ? 0 : surfaces.vertices.size() / spheres.size();
    for (std::size_t i = 0; i < depth.size(); ++i)
        for (std::size_t s = 0; s < spheres.size(); ++s)
            if (s != i / each) depth[i] = std::max(depth[i], spheres[s].radius - (surfaces.vertices[i] - spheres[s].centre).norm());
    return depth;
}

double relative_edge(std::size_t sphere_count) {
    return 1.35 / std::pow(2.0, subdivisions_for(sphere_count));
}

}  // namespace detail

TriangleMesh sphere_surfaces(std::span<const Sphere> spheres) {
    const TriangleMesh unit = detail::unit_sphere(detail::subdivisions_for(spheres.size()));
    TriangleMesh mesh;
    for (const Sphere& sphere : spheres) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const Vec3& vertex : unit.vertices) mesh.vertices.push_back(sphere.centre + sphere.radius * vertex);
        for (const Triangle& face : unit.faces) mesh.faces.push_back({first + face[0], first + face[1], first + face[2]});
    }
    return mesh;
}

}  // namespace pelletlab::report
