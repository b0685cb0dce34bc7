#include "meshes/detail/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"

namespace pelletlab::meshes::detail {
namespace {

constexpr std::uint32_t leaf_bit = 0x80000000U;
constexpr std::uint32_t leaf_size = 4;
constexpr std::size_t guess_cells = 24;  // along each axis
constexpr int stack_depth = 64;

PlaneTriangle plane_triangle(const TriangleMesh& mesh, std::uint32_t face) {
    PlaneTriangle t;
    const Vec3 a = mesh.corner(face, 0), ab = mesh.corner(face, 1) - a, ac = mesh.corner(face, 2) - a;
    t.face = face;
    t.origin = a;
    t.length = ab.norm();
    t.x = ab / t.length;
    t.z = ab.cross(ac).normalized();
    t.y = t.z.cross(t.x);
    t.cx = ac.dot(t.x);
    t.cy = ac.dot(t.y);
    t.inverse_bc = 1.0 / ((t.cx - t.length) * (t.cx - t.length) + t.cy * t.cy);
    t.inverse_ca = 1.0 / (t.cx * t.cx + t.cy * t.cy);
    return t;
}

double clamp01(double s) {
    return std::min(1.0, std::max(0.0, s));
}

/// Squared distance in the plane from (u, v) to the triangle; 0 inside.
double plane_squared_distance(const PlaneTriangle& t, double u, double v) {
    const double bx = t.cx - t.length;
    const bool outside_ab = v < 0.0;
    const bool outside_bc = bx * v - t.cy * (u - t.length) < 0.0;
    const bool outside_ca = t.cy * u - t.cx * v < 0.0;
    if (!(outside_ab || outside_bc || outside_ca)) return 0.0;
    double best = std::numeric_limits<double>::infinity();
    if (outside_ab) {
        const double du = u - std::min(t.length, std::max(0.0, u));
        best = du * du + v * v;
    }
    if (outside_bc) {
        const double s = clamp01(((u - t.length) * bx + v * t.cy) * t.inverse_bc);
        const double du = u - t.length - s * bx, dv = v - s * t.cy;
        best = std::min(best, du * du + dv * dv);
    }
    if (outside_ca) {
        const double s = clamp01((u * t.cx + v * t.cy) * t.inverse_ca);
        const double du = u - s * t.cx, dv = v - s * t.cy;
        best = std::min(best, du * du + dv * dv);
    }
    return best;
}

/// The same with the nearest point and the part of the triangle that it lies on.
NearestPoint nearest_on(const PlaneTriangle& t, const Vec3& p) {
    const Vec3 d = p - t.origin;
    const double u = d.dot(t.x), v = d.dot(t.y);
    const double bx = t.cx - t.length;
    NearestPoint nearest;
    nearest.face = t.face;
    double best = std::numeric_limits<double>::infinity();
    double pu = u, pv = v;
    const auto try_side = [&](int side, double ax, double ay, double ex, double ey, double inverse) {
        const double s = clamp01(((u - ax) * ex + (v - ay) * ey) * inverse);
        const double qu = ax + s * ex, qv = ay + s * ey;
        const double squared = (u - qu) * (u - qu) + (v - qv) * (v - qv);
        if (squared >= best) return;
        best = squared;
        pu = qu;
        pv = qv;
        nearest.feature = s <= 0.0 ? side : s >= 1.0 ? (side + 1) % 3 : 3 + side;
    };
    if (v < 0.0) try_side(0, 0.0, 0.0, t.length, 0.0, 1.0 / (t.length * t.length));
    if (bx * v - t.cy * (u - t.length) < 0.0) try_side(1, t.length, 0.0, bx, t.cy, t.inverse_bc);
    if (t.cy * u - t.cx * v < 0.0) try_side(2, t.cx, t.cy, -t.cx, -t.cy, t.inverse_ca);
    nearest.point = t.origin + pu * t.x + pv * t.y;
    const double w = d.dot(t.z);
    nearest.squared_distance = w * w + (nearest.feature == 6 ? 0.0 : best);
    return nearest;
}

double squared_distance_to(const PlaneTriangle& t, const Vec3& p, double limit) {
    const Vec3 d = p - t.origin;
    const double w = d.dot(t.z);
    const double squared = w * w;
    if (squared >= limit) return limit;
    return squared + plane_squared_distance(t, d.dot(t.x), d.dot(t.y));
}

/// Squared distance from p to a box kept as lower and upper corner. The inner loop of every query: a call would cost as much as the work.
[[gnu::always_inline]] inline double box_squared_distance(const std::array<double, 6>& box, const Vec3& p) {
    const double dx = std::max(0.0, std::max(box[0] - p.x(), p.x() - box[3]));
    const double dy = std::max(0.0, std::max(box[1] - p.y(), p.y() - box[4]));
    const double dz = std::max(0.0, std::max(box[2] - p.z(), p.z() - box[5]));
    return dx * dx + dy * dy + dz * dz;
}

double half_area(const Box& box) {
    const Vec3 d = box.sizes();
    return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

std::array<double, 6> packed(const Box& box) {
    return {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
    const auto count = static_cast<std::uint32_t>(mesh.faces.size());
    std::vector<Box> boxes(count);
    for (std::uint32_t f = 0; f < count; ++f)
        for (int k = 0; k < 3; ++k) boxes[f].extend(mesh.corner(f, k));
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    Box box;
    root_ = build(0, count, order, boxes, box);
    triangles_.reserve(count);
    for (const std::uint32_t face : order) triangles_.push_back(plane_triangle(mesh, face));
    build_guesses(box);
}

std::uint32_t TriangleTree::build(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order, const std::vector<Box>& boxes, Box& box) {
    box.setEmpty();
    for (std::uint32_t i = begin; i < end; ++i) box.extend(boxes[order[i]]);
    if (end - begin <= leaf_size) return leaf_bit | (begin * 8 + (end - begin));
    // Full sweep over the three axes: meshes are small and queries many, so the best split is worth a sort.
    double best_cost = std::numeric_limits<double>::infinity();
    int best_axis = 0;
    std::uint32_t best_split = (begin + end) / 2;
    std::vector<double> right_area(end - begin);
    const auto sort_along = [&](int axis) {
        std::sort(order.begin() + begin, order.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
            const double ca = boxes[a].min()[axis] + boxes[a].max()[axis], cb = boxes[b].min()[axis] + boxes[b].max()[axis];
            return ca != cb ? ca < cb : a < b;
        });
    };
    for (int axis = 0; axis < 3; ++axis) {
        sort_along(axis);
        Box right;
        for (std::uint32_t i = end - 1; i > begin; --i) {
            right.extend(boxes[order[i]]);
            right_area[i - begin] = half_area(right);
        }
        Box left;
        for (std::uint32_t i = begin + 1; i < end; ++i) {
            left.extend(boxes[order[i - 1]]);
            const double cost = half_area(left) * (i - begin) + right_area[i - begin] * (end - i);
            if (cost < best_cost) {
                best_cost = cost;
                best_axis = axis;
                best_split = i;
            }
        }
    }
    if (best_axis != 2) sort_along(best_axis);
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box left, right;
    const std::uint32_t left_child = build(begin, best_split, order, boxes, left);
    const std::uint32_t right_child = build(best_split, end, order, boxes, right);
    nodes_[node] = {{packed(left), packed(right)}, {left_child, right_child}};
    return node;
}

void TriangleTree::build_guesses(const Box& box) {
    const Vec3 rim = Vec3::Constant(0.25 * box.sizes().maxCoeff());
    guess_origin_ = box.min() - rim;
    const Vec3 size = box.sizes() + 2.0 * rim;
    guess_scale_ = Vec3::Constant(static_cast<double>(guess_cells)).cwiseQuotient(size);
    std::vector<std::uint32_t> found(guess_cells * guess_cells * guess_cells);
    parallel_for(guess_cells * guess_cells, 16, [&](std::size_t row) {
        Best best{std::numeric_limits<double>::infinity(), 0};
        for (std::size_t i = 0; i < guess_cells; ++i) {
            const Vec3 cell(static_cast<double>(i) + 0.5, static_cast<double>(row % guess_cells) + 0.5, static_cast<double>(row / guess_cells) + 0.5);
            const Vec3 p = guess_origin_ + cell.cwiseQuotient(guess_scale_);
            best.squared_distance = squared_distance_to(triangles_[best.triangle], p, std::numeric_limits<double>::infinity());
            search_from(p, root_, best);
            found[row * guess_cells + i] = best.triangle;
        }
    });
    guesses_ = std::move(found);
}

std::uint32_t TriangleTree::guess(const Vec3& p) const {
    const auto cell = [&](int axis) {
        const double c = (p[axis] - guess_origin_[axis]) * guess_scale_[axis];
        return static_cast<std::size_t>(std::min(static_cast<double>(guess_cells) - 1.0, std::max(0.0, c)));
    };
    return guesses_[(cell(2) * guess_cells + cell(1)) * guess_cells + cell(0)];
}

void TriangleTree::search_from(const Vec3& p, std::uint32_t start, Best& best) const {
    struct Pending {
        double squared_distance;
        std::uint32_t child;
    };
    std::array<Pending, stack_depth> stack;
    int depth = 0;
    std::uint32_t current = start;
    while (true) {
        if (current & leaf_bit) {
            const std::uint32_t first = (current & ~leaf_bit) / 8, count = current & 7U;
            for (std::uint32_t i = first; i < first + count; ++i) {
                const double squared = squared_distance_to(triangles_[i], p, best.squared_distance);
                if (squared < best.squared_distance) best = {squared, i};
            }
        } else {
            const Node& node = nodes_[current];
            const double left = box_squared_distance(node.box[0], p), right = box_squared_distance(node.box[1], p);
            const bool left_first = left <= right;
            const double near = left_first ? left : right, far = left_first ? right : left;
            if (near < best.squared_distance) {
                if (far < best.squared_distance) stack[static_cast<std::size_t>(depth++)] = {far, node.child[left_first ? 1 : 0]};
                current = node.child[left_first ? 0 : 1];
                continue;
            }
        }
        do {
            if (depth == 0) return;
            --depth;
        } while (stack[static_cast<std::size_t>(depth)].squared_distance >= best.squared_distance);
        current = stack[static_cast<std::size_t>(depth)].child;
    }
}

TriangleTree::Best TriangleTree::search(const Vec3& p) const {
    const std::uint32_t first = guess(p);
    Best best{squared_distance_to(triangles_[first], p, std::numeric_limits<double>::infinity()), first};
    search_from(p, root_, best);
    return best;
}

NearestPoint TriangleTree::nearest(const Vec3& p) const {
    return nearest_on(triangles_[search(p).triangle], p);
}

double TriangleTree::squared_distance(const Vec3& p) const {
    return search(p).squared_distance;
}

}  // namespace pelletlab::meshes::detail
