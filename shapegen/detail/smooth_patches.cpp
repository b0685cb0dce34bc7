#include "shapegen/detail/smooth_patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

namespace pelletlab::shapegen::detail {

namespace {

struct Half {
    std::uint32_t low, high, face;
    bool forward;  // runs from the lower to the higher vertex
};

// Root of a face in a forest of joined faces, shortening the way.
std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t f) {
    while (parent[f] != f) {
        parent[f] = parent[parent[f]];
        f = parent[f];
    }
    return f;
}

}  // namespace

SmoothPatches smooth_patches(const TriangleMesh& mesh, double angle) {
    std::vector<Half> halves;
    halves.reserve(3 * mesh.faces.size());
    std::vector<Vec3> normal(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        normal[f] = (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0)).normalized();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(f), a < b});
        }
    }
    std::sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) { return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face); });
    SmoothPatches patches;
    std::vector<std::uint32_t> parent(mesh.faces.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (std::size_t begin = 0, end = 0; begin < halves.size(); begin = end) {
        while (end < halves.size() && halves[end].low == halves[begin].low && halves[end].high == halves[begin].high) ++end;
        if (end - begin != 2) continue;
        const Half* faces = &halves[begin];
        const Vec3 &n = normal[faces[0].face], &m = normal[faces[1].face];
        const double bend = std::atan2(n.cross(m).norm(), n.dot(m));
        if (bend <= angle) {
            const std::uint32_t p = root(parent, faces[0].face), q = root(parent, faces[1].face);
            parent[std::max(p, q)] = std::min(p, q);
            continue;
        }
        // Convex when the second face falls away behind the first one's plane.
        const Vec3 along = (mesh.vertices[faces[0].high] - mesh.vertices[faces[0].low]) * (faces[0].forward ? 1.0 : -1.0);
        const bool convex = n.cross(m).dot(along) > 0.0;
        const Vec3 sum = n + m;
        if (sum.norm() < 1e-9) continue;
        patches.edges.push_back(
            {mesh.vertices[faces[0].low], mesh.vertices[faces[0].high], -sum.normalized(), convex ? std::numbers::pi - bend : std::numbers::pi + bend});
    }
    std::vector<std::int64_t> number(mesh.faces.size(), -1);
    patches.patch_of_face.resize(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        std::int64_t& of_root = number[root(parent, static_cast<std::uint32_t>(f))];
        if (of_root < 0) of_root = static_cast<std::int64_t>(patches.count++);
        patches.patch_of_face[f] = static_cast<std::uint32_t>(of_root);
    }
    return patches;
}

}  // namespace pelletlab::shapegen::detail
