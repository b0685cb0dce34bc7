// A lump that no formula of pellets gives: for tests of what a scanner's mesh asks of the fit.
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"
#include "meshes/detail/require.hpp"
#include "meshes/makers.hpp"
#include "meshes/pellet_makers.hpp"

namespace pelletlab::meshes {
namespace {

/// A bump around a direction: 1 there, falling like a Gaussian of the angle.
double bump(const Vec3& n, const Vec3& at, double width) {
    const double angle = std::acos(std::fmin(1.0, std::fmax(-1.0, n.dot(at.normalized()))));
    return std::exp(-0.5 * angle * angle / (width * width));
}

/// A wave over the unit sphere.
struct Wave {
    Vec3 way;
    double phase, height;
};

}  // namespace

TriangleMesh make_scan_like(const ScanLike& body, std::uint32_t subdivisions) {
    detail::require_positive(body.size, "size");
    if (!(body.roughness >= 0.0 && body.roughness <= 0.05))
        throw bad_input("the roughness of a scan-like body is not between 0 and 0.05", "choose about 0.015");
    RandomStream random(body.seed, 0x5ca9);
    std::vector<Wave> waves;
    for (int k = 0; k < 24; ++k) {
        const Vec3 way = Vec3(random.normal(), random.normal(), random.normal()).normalized() * (k < 12 ? 7.0 : 15.0);
        waves.push_back({way, random.uniform(0.0, 6.283185307179586), (k < 12 ? 1.0 : 0.5) * std::sqrt(2.0 / 15.0)});
    }
    TriangleMesh mesh = make_sphere(2.0, subdivisions);
    for (Vec3& vertex : mesh.vertices) {
        const Vec3 n = vertex.normalized();
        double radius = 0.30 + 0.08 * n.x() * n.x() + 0.20 * bump(n, {1.0, 0.0, 0.45}, 0.42);
        radius += 0.26 * bump(n, {0.75, 0.32, 0.85}, 0.13) + 0.26 * bump(n, {0.75, -0.32, 0.85}, 0.13);
        radius -= 0.12 * bump(n, {-0.3, 0.1, 1.0}, 0.35) + 0.07 * bump(n, {0.2, 1.0, -0.4}, 0.25);
        double rough = 0.0;
        for (const Wave& wave : waves) rough += wave.height * std::sin(wave.way.dot(n) + wave.phase);
        vertex = body.size * (radius + 0.5 * body.roughness * rough) * n;
    }
    return mesh;
}

}  // namespace pelletlab::meshes
