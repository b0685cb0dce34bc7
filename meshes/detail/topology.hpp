// Which triangles of a mesh meet along which edge, and what follows from it: open edges, shells, orientation. Pure combinatorics on indices.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// One side of one triangle; `low` < `high` are its vertices, `forward` says that the triangle runs from low to high.
struct HalfEdge {
    std::uint32_t low = 0, high = 0;
    std::uint32_t face = 0;
    std::uint8_t side = 0;  ///< from corner `side` to corner `side + 1`
    bool forward = false;
};

/// All sides of all triangles that have three different corners, sorted by (low, high, face): the triangles of an edge are neighbours in the list.
std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh);

/// Calls visit(begin, end) for each edge with the range of its half-edges.
template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& half_edges, const Visit& visit) {
    for (std::size_t begin = 0; begin < half_edges.size();) {
        std::size_t end = begin + 1;
        while (end < half_edges.size() && half_edges[end].low == half_edges[begin].low && half_edges[end].high == half_edges[begin].high) ++end;
        visit(&half_edges[begin], &half_edges[begin] + (end - begin));
        begin = end;
    }
}

/// Number of the shell of each triangle: triangles that share an edge belong together; shells are numbered in the order of their first triangle.
/// A triangle with a repeated corner gets the number `shell_count`.
struct Shells {
    std::vector<std::uint32_t> of_face;
    std::uint32_t count = 0;
};
Shells find_shells(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges);

/// The triangle that lies across each side; `no_face` at an open edge or where more than two triangles meet.
inline constexpr std::uint32_t no_face = 0xffffffffU;
std::vector<std::array<std::uint32_t, 3>> neighbours(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges);

/// Turns triangles so that all neighbours agree, keeping the orientation of the majority of each shell; returns how many were turned. Edges of more than two
/// triangles are not crossed; a one-sided surface keeps disagreeing edges.
std::size_t orient_consistently(TriangleMesh& mesh);

/// Vertices around which the triangles form more than one fan: two bodies that touch in a point.
std::vector<std::uint32_t> pinched_vertices(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges);

inline bool has_repeated_corner(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

}  // namespace pelletlab::meshes::detail
