#include "shapegen/detail/one_sided.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "shapegen/detail/union_boundary.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr std::uint32_t usual_iterations = 40;
constexpr double usual_tolerance = 3e-4;

// Charges one side more and more, and rewards volume (or its absence).
MinimiserResult squeeze(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points, bool inside) {
    MinimiserResult total;
    const std::array<double, 4> weights = {10.0, 100.0, 1000.0, 10000.0};
    for (const double weight : weights) {
        if (!inside && weight > 1000.0) break;
        SymmetricLoss loss(samples, context.distance, spheres, context.moments, points);
        SymmetricTerms terms;
        (inside ? terms.gaps.poking : terms.gaps.missing) = weight;
        terms.volume = 0.0;
        terms.inertia = 0.0;
        terms.volume_reward = inside ? 0.05 : -0.02;
        loss.charge_by(terms);
        const MinimiserResult stage = polish(spheres, loss, context, usual_iterations, usual_tolerance);
        total.loss = stage.loss;
        total.iterations += stage.iterations;
        total.converged = stage.converged;
    }
    return total;
}

// A ball lies in the body when its radius is at most the depth of its centre. Not below the minimum radius: then its centre moves inward.
void draw_in(Sphere& sphere, const ModeContext& context) {
    const double allowed = context.poke_out - context.exact.error_bound();
    for (int step = 0; step < 20; ++step) {
        const meshes::DistanceSample at = context.exact.sample(sphere.centre);
        const double most = allowed - at.value;
        if (most >= context.min_radius) {
            sphere.radius = std::clamp(sphere.radius, context.min_radius, most);
            return;
        }
        sphere.centre -= at.gradient * (1.01 * (context.min_radius - most));
        sphere.radius = context.min_radius;
    }
}

// Growth that puts a triangle into one sphere.
double growth_for(const std::vector<Sphere>& spheres, const std::array<Vec3, 3>& corner) {
    double least = std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : spheres) {
        double needed = (corner[0] - sphere.centre).norm() - sphere.radius;
        if (needed >= least) continue;
        needed = std::max(needed, (corner[1] - sphere.centre).norm() - sphere.radius);
        if (needed >= least) continue;
        least = std::min(least, std::max(needed, (corner[2] - sphere.centre).norm() - sphere.radius));
    }
    return least;
}

double growth_for_pieces(const std::vector<Sphere>& spheres, const std::array<Vec3, 3>& corner, double finest, double known) {
    const double needed = growth_for(spheres, corner);
    if (needed <= known) return known;
    std::size_t longest = 0;
    double length = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double side = (corner[(k + 1) % 3] - corner[k]).norm();
        if (side > length) {
            length = side;
            longest = k;
        }
    }
    if (length <= finest) return needed;
    const Vec3 &a = corner[longest], &b = corner[(longest + 1) % 3], &c = corner[(longest + 2) % 3];
    const Vec3 middle = 0.5 * (a + b);
    return growth_for_pieces(spheres, {middle, b, c}, finest, growth_for_pieces(spheres, {a, middle, c}, finest, known));
}

}  // namespace

double largest_poke_out(const std::vector<Sphere>& spheres, const meshes::SignedDistance& exact) {
    double largest = -std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : spheres) largest = std::max(largest, sphere.radius + exact.value(sphere.centre));
    return largest;
}

double missing_radius(const std::vector<Sphere>& spheres, const TriangleMesh& mesh, const meshes::SignedDistance& exact, double finest) {
    const auto larger = [](double a, double b) { return std::max(a, b); };
    const double on_surface = parallel_reduce(
        mesh.faces.size(), 64, 0.0,
        [&](std::size_t begin, std::size_t end) {
            double known = 0.0;  // pieces that need no more than another one need no cutting
            for (std::size_t f = begin; f < end; ++f)
                known = growth_for_pieces(spheres, {mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)}, finest, known);
            return known;
        },
        larger);
    // A hole inside a body whose surface is covered is walled by concave patches, and those end in creases.
    const std::vector<ExposedPart> boundary = union_boundary(spheres);
    const double in_holes = parallel_reduce(
        boundary.size(), 4, 0.0,
        [&](std::size_t begin, std::size_t end) {
            double deepest = 0.0;
            for (std::size_t i = begin; i < end; ++i) {
                for (const ExposedArc& arc : boundary[i].arcs) {
                    const Sphere& sphere = spheres[arc.sphere];
                    const Vec3 n = arc.cos_opening * arc.axis + arc.sin_opening * (arc.u * std::cos(arc.begin) + arc.v * std::sin(arc.begin));
                    deepest = std::max(deepest, exact.error_bound() - exact.value(sphere.centre + sphere.radius * n));
                }
            }
            return deepest;
        },
        larger);
    return std::max(on_surface, in_holes);
}

MinimiserResult fit_inside(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points) {
    MinimiserResult total = squeeze(spheres, context, samples, points, true);
    for (Sphere& sphere : spheres) draw_in(sphere, context);
    if (context.map != nullptr) {  // the mesh need not be as symmetric as its clump: images take the smallest radius that one of them needs
        restore_symmetry(spheres, context);
        for (Sphere& sphere : spheres) draw_in(sphere, context);
        restore_symmetry(spheres, context);
    }
    return total;
}

MinimiserResult fit_outside(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points) {
    MinimiserResult total = squeeze(spheres, context, samples, points, false);
    restore_symmetry(spheres, context);
    constexpr double finest = 1e-3;
    for (int round = 0; round < 100; ++round) {
        const double growth = missing_radius(spheres, context.mesh, context.exact, finest);
        if (growth <= 0.0) return total;
        for (Sphere& sphere : spheres) sphere.radius += growth * (1.0 + 1e-12) + 1e-14;
    }
    total.converged = false;
    return total;
}

}  // namespace pelletlab::shapegen::detail
