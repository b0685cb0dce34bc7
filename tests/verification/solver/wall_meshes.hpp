// Meshes for the tests of walls: folds, hills, boxes and planes in many triangulations.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene.hpp"

namespace pelletlab::solver::scene {

/// Two rectangles that meet along the y axis; positive bend [rad]: a valley seen from +z, negative: a ridge.
inline TriangleMesh fold(double bend, double half, double half_length) {
    TriangleMesh mesh;
    const Vec3 left(-half * std::cos(0.5 * bend), 0.0, half * std::sin(0.5 * bend)), right(half * std::cos(0.5 * bend), 0.0, half * std::sin(0.5 * bend));
    for (const double y : {-half_length, half_length})
        for (const Vec3& side : {left, Vec3(Vec3::Zero()), right}) mesh.vertices.push_back(side + Vec3(0.0, y, 0.0));
    mesh.faces = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    return mesh;
}

/// Square plate in z = 0 into which random points are put, each joined to the corners of the triangle that holds it: triangles of all sizes, many of them
/// slivers. Points that would make a triangle lower than `least_height` are left out.
inline TriangleMesh random_cut(double half, int points, double least_height, std::uint64_t seed) {
    TriangleMesh mesh = plate(half);
    const auto height = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        return (b - a).cross(c - a).z() / std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    };
    RandomStream random(seed, 0);
    for (int k = 0; k < points; ++k) {
        const Vec3 p(random.uniform(-half, half), random.uniform(-half, half), 0.0);
        for (Triangle& f : mesh.faces) {
            const Triangle old = f;
            const Vec3 &a = mesh.vertices[old[0]], &b = mesh.vertices[old[1]], &c = mesh.vertices[old[2]];
            if (std::min({height(a, b, p), height(b, c, p), height(c, a, p)}) < least_height) continue;
            const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
            f = {old[0], old[1], n};
            mesh.faces.push_back({old[1], old[2], n});
            mesh.faces.push_back({old[2], old[0], n});
            mesh.vertices.push_back(p);
            break;
        }
    }
    return mesh;
}

/// A plate of n × n cells whose vertices have random heights.
inline TriangleMesh hills(double half, int n, double height, std::uint64_t seed) {
    TriangleMesh mesh = plate(half, n);
    RandomStream random(seed, 0);
    for (Vec3& v : mesh.vertices) v.z() = random.uniform(-0.5, 0.5) * height;
    return mesh;
}

/// Triangles in another order, some turned round, corners rotated.
inline TriangleMesh shuffled(TriangleMesh mesh, std::uint64_t seed) {
    RandomStream random(seed, 0);
    for (std::size_t k = mesh.faces.size(); k > 1; --k)
        std::swap(mesh.faces[k - 1], mesh.faces[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
    for (Triangle& f : mesh.faces) {
        if (random.uniform() < 0.5) std::swap(f[0], f[1]);
        std::rotate(f.begin(), f.begin() + static_cast<int>(random.uniform() * 3.0), f.end());
    }
    return mesh;
}

/// Closed box whose faces are n × n cells each; corners and edges are shared.
inline TriangleMesh fine_box(const Vec3& low, const Vec3& high, int n) {
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            for (int j = 0; j <= n; ++j)
                for (int i = 0; i <= n; ++i) {
                    Vec3 p;
                    p[axis] = upper ? high[axis] : low[axis];
                    p[u] = i == n ? high[u] : low[u] + (high[u] - low[u]) * i / n;
                    p[v] = j == n ? high[v] : low[v] + (high[v] - low[v]) * j / n;
                    mesh.vertices.push_back(p);
                }
            const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                    mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
                }
        }
    return mesh;
}

/// Distance between a point and a triangle by projection on its plane and its three sides.
inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a).normalized();
    const Vec3 foot = p - n * n.dot(p - a);
    const auto inside = [&](const Vec3& u, const Vec3& v) { return (v - u).cross(foot - u).dot(n) >= 0.0; };
    if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(n.dot(p - a));
    double best = 1e300;
    for (const auto& [u, v] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        const double t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
        best = std::min(best, (p - u - t * (v - u)).norm());
    }
    return best;
}

/// Height at which a sphere over (x, y) is `overlap` deep in a mesh of hills not higher than a centimetre.
inline double resting_height(const TriangleMesh& mesh, const Vec3& place, double radius, double overlap) {
    std::vector<Triangle> near;
    for (const Triangle& f : mesh.faces) {
        const Vec3 away = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3.0 - place;
        if (away.head<2>().norm() < 3.0 * radius) near.push_back(f);
    }
    const auto gap = [&](double z) {
        double best = 1e300;
        for (const Triangle& f : near)
            best = std::min(best, distance_to_triangle({place.x(), place.y(), z}, mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]));
        return best;
    };
    double high = 0.01;
    while (gap(high - 1e-4) > radius - overlap) high -= 1e-4;  // from above down to the first place that is deep enough
    double low = high - 1e-4;
    for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (low + high);
        (gap(middle) > radius - overlap ? high : low) = middle;
    }
    return low;
}

}  // namespace pelletlab::solver::scene
