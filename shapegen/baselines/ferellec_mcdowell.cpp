#include <algorithm>
#include <numeric>

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "shapegen/baselines/baselines.hpp"
#include "shapegen/detail/medial_balls.hpp"
#include "shapegen/detail/surface_samples.hpp"

namespace pelletlab::shapegen::baselines {

namespace {

constexpr std::size_t surface_points = 8000;

// Spheres of one pass: points in that order, each farther than d_min from all spheres so far gives its ball.
std::vector<Sphere> one_pass(const std::vector<Vec3>& points, const std::vector<Sphere>& balls, const std::vector<std::uint32_t>& order, double d_min,
                             std::size_t most) {
    std::vector<Sphere> spheres;
    for (const std::uint32_t i : order) {
        const auto near = [&](const Sphere& s) { return (points[i] - s.centre).norm() - s.radius <= d_min; };
        if (std::any_of(spheres.begin(), spheres.end(), near)) continue;
        spheres.push_back(balls[i]);
        if (spheres.size() > most) break;
    }
    return spheres;
}

}  // namespace

std::vector<Sphere> ferellec_mcdowell(const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings) {
    const detail::SurfaceSamples samples = detail::sample_surface(body, surface_points, settings.seed);
    const double extent = bounding_box(body).sizes().minCoeff();
    // The original lets a ball contain no vertex at all; between vertices it bulges out by about as much as this tolerance.
    const double tolerance = 2e-3 * extent;
    std::vector<Sphere> balls(samples.points.size());
    parallel_for(balls.size(), 64, [&](std::size_t i) {
        const double r = detail::medial_radius(exact, samples.points[i], samples.normals[i], 0.5 * extent, tolerance);
        balls[i] = {samples.points[i] - r * samples.normals[i], r};
    });
    std::vector<std::uint32_t> order(balls.size());
    std::iota(order.begin(), order.end(), 0u);
    RandomStream random(settings.seed, 0xfe11);
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);

    double fine = 0.0, coarse = extent;  // fine gives too many spheres, coarse not
    std::vector<Sphere> best = one_pass(samples.points, balls, order, coarse, settings.sphere_count);
    for (int round = 0; round < 24 && best.size() != settings.sphere_count; ++round) {
        const double middle = 0.5 * (fine + coarse);
        std::vector<Sphere> spheres = one_pass(samples.points, balls, order, middle, settings.sphere_count);
        if (spheres.size() > settings.sphere_count) {
            fine = middle;
            continue;
        }
        coarse = middle;
        if (spheres.size() >= best.size()) best = std::move(spheres);
    }
    return best;
}

}  // namespace pelletlab::shapegen::baselines
