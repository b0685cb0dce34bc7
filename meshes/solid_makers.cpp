// Closed bodies of makers.hpp: cylinder, box, sphere.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "meshes/detail/require.hpp"
#include "meshes/detail/rings.hpp"
#include "meshes/makers.hpp"

namespace pelletlab::meshes {
namespace {

constexpr std::uint32_t max_side_quads = 2048;  // more rows are not made beyond that; a single row always is
constexpr std::size_t max_cap_faces = 800;

}  // namespace

TriangleMesh make_cylinder(double diameter, double height, std::uint32_t facets, bool volume_exact) {
    detail::require_positive(diameter, "diameter");
    detail::require_positive(height, "height");
    detail::require_facets(facets);
    const double radius = 0.5 * diameter * (volume_exact ? detail::equal_area_factor(facets) : 1.0);
    const double edge = 2.0 * radius * std::sin(std::numbers::pi / facets);
    const double most_rows = std::max(1.0, std::floor(static_cast<double>(max_side_quads) / facets));
    const auto rows = static_cast<std::uint32_t>(std::clamp(std::round(height / edge), 1.0, most_rows));

    TriangleMesh mesh;
    std::vector<detail::Ring> rings;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        const double z = height * (static_cast<double>(row) / rows - 0.5);
        rings.push_back(detail::add_ring(mesh, facets, radius, z));
        if (row > 0) detail::add_band(mesh, rings[row - 1], rings[row]);
    }
    detail::add_flat_cap(mesh, rings.back(), radius, 0.5 * height, true, max_cap_faces);
    detail::add_flat_cap(mesh, rings.front(), radius, -0.5 * height, false, max_cap_faces);
    return mesh;
}

TriangleMesh make_box(const Vec3& lower, const Vec3& upper) {
    for (int axis = 0; axis < 3; ++axis) detail::require_positive(upper[axis] - lower[axis], "edge");
    TriangleMesh mesh;
    for (unsigned corner = 0; corner < 8; ++corner)
        mesh.vertices.emplace_back(corner & 1U ? upper.x() : lower.x(), corner & 2U ? upper.y() : lower.y(), corner & 4U ? upper.z() : lower.z());
    const std::array<std::array<std::uint32_t, 4>, 6> sides = {{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& side : sides) {
        mesh.faces.push_back({side[0], side[1], side[2]});
        mesh.faces.push_back({side[0], side[2], side[3]});
    }
    return mesh;
}

TriangleMesh make_sphere(double diameter, std::uint32_t subdivisions) {
    detail::require_positive(diameter, "diameter");
    if (subdivisions > 9) throw bad_input("a sphere of more than 9 subdivisions has over 5 million faces", "use 4 or 5");
    // Icosahedron on the golden ratio.
    const double t = std::numbers::phi;
    TriangleMesh mesh;
    for (const auto& [x, y, z] : std::array<std::array<double, 3>, 12>{
             {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0}, {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t}, {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}}})
        mesh.vertices.push_back(Vec3(x, y, z).normalized());
    mesh.faces = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                  {3, 9, 4},  {3, 4, 2}, {3, 2, 6}, {3, 6, 8},  {3, 8, 9},   {4, 9, 5}, {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (std::uint32_t level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle_of;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [place, is_new] = middle_of.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
            return place->second;
        };
        std::vector<Triangle> finer;
        finer.reserve(4 * mesh.faces.size());
        for (const auto& [a, b, c] : mesh.faces) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}});
        }
        mesh.faces = std::move(finer);
    }
    for (Vec3& vertex : mesh.vertices) vertex *= 0.5 * diameter;
    return mesh;
}

}  // namespace pelletlab::meshes
