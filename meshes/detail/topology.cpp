#include "meshes/detail/topology.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pelletlab::meshes::detail {
namespace {

/// Sets of numbers that are joined step by step (union–find with path halving).
class DisjointSets {
public:
    explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
    std::vector<HalfEdge> list;
    list.reserve(3 * mesh.faces.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const Triangle& t = mesh.faces[f];
        if (has_repeated_corner(t)) continue;
        for (std::uint8_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1U) % 3U];
            list.push_back({std::min(a, b), std::max(a, b), f, k, a < b});
        }
    }
    std::sort(list.begin(), list.end(), [](const HalfEdge& a, const HalfEdge& b) { return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face); });
    return list;
}

Shells find_shells(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges) {
    DisjointSets sets(mesh.faces.size());
    for_each_edge(half_edges, [&](const HalfEdge* begin, const HalfEdge* end) {
        for (const HalfEdge* h = begin + 1; h < end; ++h) sets.join(begin->face, h->face);
    });
    Shells shells;
    shells.of_face.assign(mesh.faces.size(), no_face);
    std::vector<std::uint32_t> number(mesh.faces.size(), no_face);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        if (has_repeated_corner(mesh.faces[f])) continue;
        std::uint32_t& shell = number[sets.root(f)];
        if (shell == no_face) shell = shells.count++;
        shells.of_face[f] = shell;
    }
    for (std::uint32_t& shell : shells.of_face)
        if (shell == no_face) shell = shells.count;
    return shells;
}

std::vector<std::array<std::uint32_t, 3>> neighbours(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges) {
    std::vector<std::array<std::uint32_t, 3>> across(mesh.faces.size(), {no_face, no_face, no_face});
    for_each_edge(half_edges, [&](const HalfEdge* begin, const HalfEdge* end) {
        if (end - begin != 2) return;
        across[begin[0].face][begin[0].side] = begin[1].face;
        across[begin[1].face][begin[1].side] = begin[0].face;
    });
    return across;
}

std::size_t orient_consistently(TriangleMesh& mesh) {
    struct Link {
        std::uint32_t face = no_face;
        bool agrees = true;
    };
    std::vector<std::array<Link, 3>> links(mesh.faces.size());
    for_each_edge(sorted_half_edges(mesh), [&](const HalfEdge* begin, const HalfEdge* end) {
        if (end - begin != 2) return;
        const bool agrees = begin[0].forward != begin[1].forward;
        links[begin[0].face][begin[0].side] = {begin[1].face, agrees};
        links[begin[1].face][begin[1].side] = {begin[0].face, agrees};
    });
    enum class State : std::uint8_t { unseen, kept, turned };
    using enum State;
    std::vector<State> state(mesh.faces.size(), unseen);
    std::size_t count = 0;
    for (std::uint32_t seed = 0; seed < mesh.faces.size(); ++seed) {
        if (state[seed] != unseen) continue;
        state[seed] = kept;
        std::vector<std::uint32_t> patch{seed};
        std::size_t turned_here = 0;
        for (std::size_t next = 0; next < patch.size(); ++next) {
            const std::uint32_t face = patch[next];
            for (const Link& link : links[face]) {
                if (link.face == no_face || state[link.face] != unseen) continue;
                state[link.face] = link.agrees ? state[face] : (state[face] == kept ? turned : kept);
                turned_here += state[link.face] == turned;
                patch.push_back(link.face);
            }
        }
        const bool majority_turned = 2 * turned_here > patch.size();
        for (const std::uint32_t face : patch)
            if ((state[face] == turned) != majority_turned) {
                std::swap(mesh.faces[face][1], mesh.faces[face][2]);
                ++count;
            }
    }
    return count;
}

std::vector<std::uint32_t> pinched_vertices(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges) {
    // Corners 3f + k are joined across every edge at both of its ends; a vertex whose corners fall into several sets has several fans.
    DisjointSets corners(3 * mesh.faces.size());
    const auto corner = [&](std::uint32_t face, std::uint32_t vertex) {
        const Triangle& t = mesh.faces[face];
        return 3 * face + (t[0] == vertex ? 0U : t[1] == vertex ? 1U : 2U);
    };
    for_each_edge(half_edges, [&](const HalfEdge* begin, const HalfEdge* end) {
        for (const HalfEdge* h = begin + 1; h < end; ++h)
            for (const std::uint32_t vertex : {begin->low, begin->high}) corners.join(corner(begin->face, vertex), corner(h->face, vertex));
    });
    std::vector<std::uint32_t> fan(mesh.vertices.size(), no_face), pinched;
    std::vector<bool> noted(mesh.vertices.size(), false);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        if (has_repeated_corner(mesh.faces[f])) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.faces[f][k], root = corners.root(3 * f + k);
            if (fan[vertex] == no_face) fan[vertex] = root;
            if (fan[vertex] != root && !noted[vertex]) {
                noted[vertex] = true;
                pinched.push_back(vertex);
            }
        }
    }
    std::sort(pinched.begin(), pinched.end());
    return pinched;
}

}  // namespace pelletlab::meshes::detail
