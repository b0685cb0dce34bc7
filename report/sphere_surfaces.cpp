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

ShowingSurface showing_surface(std::span<const Sphere> spheres) {
    const TriangleMesh unit = unit_sphere(subdivisions_for(spheres.size()));
    const double edge = relative_edge(spheres.size());
    ShowingSurface surface;
    std::vector<std::uint32_t> covers;                          // spheres that may hide a part of this one
    std::vector<std::uint32_t> place(unit.vertices.size(), 0);  // in the result, of the unit sphere's vertices that can show
    constexpr std::uint32_t hidden = 0xffffffffu;
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        const Sphere& own = spheres[i];
        const double rim = edge * own.radius;
        covers.clear();
        for (std::uint32_t s = 0; s < spheres.size(); ++s)
            if (s != i && spheres[s].radius > rim && (spheres[s].centre - own.centre).norm() < spheres[s].radius - rim + own.radius) covers.push_back(s);
        for (std::size_t v = 0; v < unit.vertices.size(); ++v) {
            const Vec3 p = own.centre + own.radius * unit.vertices[v];
            const auto hides = [&](std::uint32_t s) {
                const double reach = spheres[s].radius - rim;
                return (p - spheres[s].centre).squaredNorm() < reach * reach;
            };
            const auto found = std::find_if(covers.begin(), covers.end(), hides);
            place[v] = hidden;
            if (found != covers.end()) {
                std::swap(*found, covers.front());  // which often hides the next vertex, too
                continue;
            }
            place[v] = static_cast<std::uint32_t>(surface.mesh.vertices.size());
            surface.mesh.vertices.push_back(p);
            surface.normals.push_back(unit.vertices[v]);
            surface.sphere.push_back(i);
            surface.number.push_back(i * unit.vertices.size() + v);
        }
        for (const Triangle& face : unit.faces) {
            const Triangle placed = {place[face[0]], place[face[1]], place[face[2]]};
            if (std::find(placed.begin(), placed.end(), hidden) == placed.end()) surface.mesh.faces.push_back(placed);
        }
    }
    return surface;
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
