// Nearest triangle to a point: a binary tree of bounding boxes (surface-area heuristic) over triangles in their own plane frames, and a coarse
// grid of first guesses that lets the search start with a tight bound.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Part of a triangle that holds the nearest point: 0–2 corner k, 3–5 side from corner k − 3, 6 the inside.
struct NearestPoint {
    std::uint32_t face = 0;
    int feature = 6;
    Vec3 point = Vec3::Zero();      ///< [m]
    double squared_distance = 0.0;  ///< [m²]
};

/// A triangle without degenerate shape in the frame (origin a, x along a→b, z along the normal), after Jones (1995), "3D distance from a point
/// to a triangle": one dot product rejects it by its plane, two more leave a plane problem.
struct PlaneTriangle {
    Vec3 origin, x, y, z;
    double length = 0.0;                        ///< b = (length, 0)
    double cx = 0.0, cy = 0.0;                  ///< c = (cx, cy), cy > 0
    double inverse_bc = 0.0, inverse_ca = 0.0;  ///< 1 / |side|²
    std::uint32_t face = 0;
};

class TriangleTree {
public:
    explicit TriangleTree(const TriangleMesh& mesh);
    NearestPoint nearest(const Vec3& p) const;
    double squared_distance(const Vec3& p) const;

private:
    /// Two children; a child is a node, or with the high bit set a leaf of up to 4 triangles: first · 8 + count.
    struct Node {
        std::array<std::array<double, 6>, 2> box;  ///< −lower and upper: max(−lower + p, p − upper) … see box_distance
        std::array<std::uint32_t, 2> child;
    };
    struct Best {
        double squared_distance;
        std::uint32_t triangle;
    };
    Best search(const Vec3& p) const;
    void search_from(const Vec3& p, std::uint32_t start, Best& best) const;
    std::uint32_t build(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order, const std::vector<Box>& boxes, Box& box);
    void build_guesses(const Box& box);
    std::uint32_t guess(const Vec3& p) const;

    std::vector<PlaneTriangle> triangles_;  ///< in tree order
    std::vector<Node> nodes_;
    std::uint32_t root_ = 0;
    Vec3 guess_origin_ = Vec3::Zero();
    Vec3 guess_scale_ = Vec3::Zero();  ///< cells per metre
    std::vector<std::uint32_t> guesses_;
};

}  // namespace pelletlab::meshes::detail
