#include "shapegen/detail/surface_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"

namespace pelletlab::shapegen::detail {

namespace {

struct Piece {
    std::array<Vec3, 3> corner;
    Vec3 normal;
    double area;
    std::uint64_t key;
    std::uint32_t face;
};

// Spreads the lower 21 bits so that two zero bits follow each.
std::uint64_t spread(std::uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    return x;
}

std::uint64_t morton_key(const Vec3& p, const Box& box) {
    const double scale = 2097151.0 / box.sizes().maxCoeff();
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key |= spread(static_cast<std::uint64_t>((p[k] - box.min()[k]) * scale)) << k;
    return key;
}

// Halves a triangle across its longest edge until its area is small enough.
void cut(const Piece& piece, double largest_area, const Box& box, std::vector<Piece>& out) {
    if (piece.area <= largest_area) {
        out.push_back(piece);
        out.back().key = morton_key((piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3.0, box);
        return;
    }
    std::size_t longest = 0;
    double best = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double length = (piece.corner[(k + 1) % 3] - piece.corner[k]).squaredNorm();
        if (length > best) {
            best = length;
            longest = k;
        }
    }
    const Vec3& a = piece.corner[longest];
    const Vec3& b = piece.corner[(longest + 1) % 3];
    const Vec3& c = piece.corner[(longest + 2) % 3];
    const Vec3 middle = 0.5 * (a + b);
    cut({{a, middle, c}, piece.normal, 0.5 * piece.area, 0, piece.face}, largest_area, box, out);
    cut({{middle, b, c}, piece.normal, 0.5 * piece.area, 0, piece.face}, largest_area, box, out);
}

}  // namespace

SurfaceSamples sample_surface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
    SurfaceSamples samples;
    std::vector<Piece> whole;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        Piece piece{{mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)}, Vec3::Zero(), 0.0, 0, static_cast<std::uint32_t>(f)};
        const Vec3 normal = (piece.corner[1] - piece.corner[0]).cross(piece.corner[2] - piece.corner[0]);
        piece.area = 0.5 * normal.norm();
        if (!(piece.area > 0.0)) continue;
        piece.normal = normal.normalized();
        samples.area += piece.area;
        whole.push_back(piece);
    }
    if (whole.empty() || count == 0) throw bad_input("the mesh has no area to sample", "check the mesh");
    const Box box = bounding_box(mesh);
    const double stratum = samples.area / static_cast<double>(count);
    std::vector<Piece> pieces;
    pieces.reserve(4 * count + whole.size());  // each is between a quarter and a half of a stratum
    for (const Piece& piece : whole) cut(piece, 0.5 * stratum, box, pieces);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(pieces.size());
    for (std::size_t k = 0; k < pieces.size(); ++k) order[k] = {pieces[k].key, static_cast<std::uint32_t>(k)};
    std::sort(order.begin(), order.end());

    samples.points.reserve(count);
    samples.normals.reserve(count);
    RandomStream random(seed, 0x5a3d);
    double passed = 0.0;  // area before the current piece
    std::size_t k = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double target = (static_cast<double>(i) + random.uniform()) * stratum;
        while (k + 1 < order.size() && passed + pieces[order[k].second].area < target) passed += pieces[order[k++].second].area;
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const Piece& piece = pieces[order[k].second];
        const auto& [a, b, c] = piece.corner;
        samples.points.push_back(a + u * (b - a) + v * (c - a));
        samples.normals.push_back(piece.normal);
        samples.faces.push_back(piece.face);
    }
    return samples;
}

void sort_by_place(std::vector<Vec3>& points, const Box& box) {
    std::vector<std::pair<std::uint64_t, std::size_t>> order(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) order[k] = {morton_key(points[k], box), k};
    std::sort(order.begin(), order.end());
    std::vector<Vec3> sorted;
    sorted.reserve(points.size());
    for (const auto& [key, k] : order) sorted.push_back(points[k]);
    points = std::move(sorted);
}

}  // namespace pelletlab::shapegen::detail
