#include "meshes/detail/clean.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "meshes/detail/topology.hpp"

namespace pelletlab::meshes::detail {
namespace {

constexpr double degenerate_ratio = 1e-10;

struct Sides {
    std::array<double, 3> length;  ///< of the side from corner k to k + 1
    std::size_t longest, shortest;
};

Sides sides_of(const TriangleMesh& mesh, const Triangle& t) {
    Sides sides{};
    for (std::size_t k = 0; k < 3; ++k) sides.length[k] = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).norm();
    sides.longest = static_cast<std::size_t>(std::max_element(sides.length.begin(), sides.length.end()) - sides.length.begin());
    sides.shortest = static_cast<std::size_t>(std::min_element(sides.length.begin(), sides.length.end()) - sides.length.begin());
    return sides;
}

Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

/// One sweep over the degenerate triangles; those next to a change wait for the next sweep. Returns the number of changes.
std::size_t sweep(TriangleMesh& mesh) {
    const std::vector<HalfEdge> half_edges = sorted_half_edges(mesh);
    const auto across = neighbours(mesh, half_edges);
    const auto edge_exists = [&](std::uint32_t a, std::uint32_t b) {
        const HalfEdge wanted{std::min(a, b), std::max(a, b)};
        const auto place = std::lower_bound(half_edges.begin(), half_edges.end(), wanted,
                                            [](const HalfEdge& p, const HalfEdge& q) { return std::tie(p.low, p.high) < std::tie(q.low, q.high); });
        return place != half_edges.end() && place->low == wanted.low && place->high == wanted.high;
    };
    std::vector<bool> touched(mesh.faces.size(), false);
    const auto touch = [&](std::uint32_t face) {
        touched[face] = true;
        for (const std::uint32_t other : across[face])
            if (other != no_face) touched[other] = true;
    };
    std::vector<std::uint32_t> moved_to(mesh.vertices.size());
    std::iota(moved_to.begin(), moved_to.end(), 0U);
    std::size_t changes = 0;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const Triangle t = mesh.faces[f];
        if (touched[f] || !is_degenerate(mesh, t)) continue;
        const Sides sides = sides_of(mesh, t);
        if (sides.length[sides.shortest] <= degenerate_ratio * sides.length[sides.longest]) {
            const std::uint32_t a = t[sides.shortest], b = t[(sides.shortest + 1) % 3];
            if (moved_to[a] != a || moved_to[b] != b) continue;
            moved_to[std::max(a, b)] = std::min(a, b);
            touch(f);
            ++changes;
            continue;
        }
        const std::size_t k = sides.longest;
        const std::uint32_t g = across[f][k];
        if (g == no_face || touched[g]) continue;
        const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        const Triangle& u = mesh.faces[g];
        const std::uint32_t d = u[0] != a && u[0] != b ? u[0] : (u[1] != a && u[1] != b ? u[1] : u[2]);
        if (d == c || edge_exists(c, d)) continue;
        touch(f);
        touch(g);
        mesh.faces[f] = {a, d, c};
        mesh.faces[g] = {d, b, c};
        ++changes;
    }
    for (Triangle& t : mesh.faces)
        for (std::uint32_t& vertex : t)
            while (moved_to[vertex] != vertex) vertex = moved_to[vertex];
    drop_repeated_corners(mesh);
    return changes;
}

}  // namespace

bool is_degenerate(const TriangleMesh& mesh, const Triangle& t) {
    if (has_repeated_corner(t)) return true;
    const Vec3 ab = mesh.vertices[t[1]] - mesh.vertices[t[0]], ac = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double longest_squared = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    return ab.cross(ac).norm() <= degenerate_ratio * longest_squared;
}

std::size_t drop_duplicates(TriangleMesh& mesh) {
    std::set<Triangle> seen;
    return std::erase_if(mesh.faces, [&](const Triangle& t) { return !seen.insert(sorted(t)).second; });
}

std::size_t drop_repeated_corners(TriangleMesh& mesh) {
    return std::erase_if(mesh.faces, has_repeated_corner);
}

std::size_t remove_degenerate(TriangleMesh& mesh) {
    const auto count = [&] {
        return static_cast<std::size_t>(std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const Triangle& t) { return is_degenerate(mesh, t); }));
    };
    const std::size_t before = count();
    for (int pass = 0; pass < 200 && count() > 0; ++pass)
        if (sweep(mesh) == 0) break;
    return before - std::min(before, count());
}

}  // namespace pelletlab::meshes::detail
