#include "shapegen/fit.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/detail/body_frame.hpp"
#include "shapegen/detail/match_moments.hpp"
#include "shapegen/detail/relocation.hpp"
#include "shapegen/detail/seeding.hpp"
#include "shapegen/detail/settle.hpp"
#include "shapegen/detail/surface_samples.hpp"
#include "shapegen/detail/symmetric_loss.hpp"

namespace pelletlab::shapegen {

namespace {

using namespace detail;

constexpr std::uint32_t most_spheres = 2000;

// The body in the frame of the fit.
struct Body {
    UnitFrame frame;
    TriangleMesh mesh;
    BodyMoments moments;
    double smallest_extent = 0.0;
};

Body unit_body(const TriangleMesh& mesh) {
    const MassProperties mass = meshes::mass_properties(mesh, 1.0);
    Body body;
    body.frame = {mass.centre_of_mass_mesh, std::cbrt(mass.volume)};
    body.mesh = body.frame.to_unit(mesh);
    body.smallest_extent = bounding_box(body.mesh).sizes().minCoeff();
    // Principal inertia → covariance: I = tr(C)·1 − C at mass 1.
    const Vec3 inertia = mass.principal_inertia / (mass.volume * body.frame.length * body.frame.length);
    const Vec3 spread = Vec3::Constant(0.5 * inertia.sum()) - inertia;
    const Mat3 axes = mass.principal_axes.toRotationMatrix();
    body.moments = {1.0, Vec3::Zero(), axes * spread.asDiagonal() * axes.transpose()};
    return body;
}

void check(const FitSettings& settings, const Body& body) {
    if (settings.sphere_count == 0) throw bad_input("a clump needs at least one sphere", "ask for 1 to " + std::to_string(most_spheres) + " spheres");
    if (settings.sphere_count > most_spheres) {
        throw bad_input("a clump of " + std::to_string(settings.sphere_count) + " spheres is out of reach",
                        "ask for 1 to " + std::to_string(most_spheres) + " spheres");
    }
    if (!(settings.min_radius >= 0.0)) throw bad_input("the minimum radius is negative or not a number", "give 0 or a positive length");
    if (settings.min_radius >= 0.5 * body.smallest_extent * body.frame.length) {
        throw bad_input("the minimum radius is larger than the body", "choose one below half the smallest extent of the mesh");
    }
    if (!(settings.effort >= 0.0)) throw bad_input("the effort is negative or not a number", "give 1 for the usual search, 0 for none");
}

// Gaps of a good fit, measured on cylinders; only tells what counts as small.
double expected_gap(std::size_t spheres) {
    return 0.019 * std::pow(24.0 / static_cast<double>(spheres), 0.68);
}

SampleBlocks samples_of(const Body& body, std::size_t count, std::uint64_t seed) {
    return make_blocks(sample_surface(body.mesh, count, seed));
}

}  // namespace

FitResult fit_spheres(const TriangleMesh& mesh, const meshes::SignedDistance& distance, const FitSettings& settings, const ProgressSink& progress) {
    const auto tell = [&](const char* stage, double done, double total) {
        if (progress) progress({stage, done, total, "", 0.0, "", ""});
    };
    const Body body = unit_body(mesh);
    check(settings, body);
    const UnitDistance unit_distance(distance, body.frame);
    const std::size_t n = settings.sphere_count;
    // Spheres much smaller than the gaps fit the noise of the samples, not the body.
    const double min_radius = std::max(settings.min_radius / body.frame.length, std::min(2.0 * expected_gap(n), 0.05 * body.smallest_extent));
    FitResult result;

    tell("seeding spheres", 0.0, 1.0);
    const SampleBlocks coarse = samples_of(body, std::max<std::size_t>(3000, 150 * n), settings.seed);
    SeedSettings seeds;
    seeds.count = n;
    seeds.min_radius = min_radius;
    seeds.largest_radius = 0.5 * body.smallest_extent;
    seeds.tolerance = std::min(0.3 * expected_gap(n), 0.02 * body.smallest_extent);
    std::vector<Sphere> spheres = seed_by_gaps(coarse, unit_distance, seeds);

    tell("fitting spheres", 0.0, 1.0);
    Containment containment{&unit_distance, 0.0};
    const auto settle_all = [&](const SampleBlocks& samples, std::uint32_t iterations, double tolerance) {
        GapLoss loss(samples, spheres);
        // Reaching out by twice the usual gap is what a good fit does at edges.
        loss.evaluate(pack(spheres), nullptr, nullptr);
        containment.slack = 2.0 * std::sqrt(loss.gap_part());
        loss.contain(containment);
        const MinimiserResult settled = settle(loss, {iterations, tolerance, min_radius, 0.05});
        loss.copy_spheres(spheres);
        result.iterations += settled.iterations;
    };
    settle_all(coarse, 60, 1e-3);

    tell("moving spheres to better places", 0.0, 1.0);
    RelocationSettings relocation;
    relocation.trials = static_cast<std::uint32_t>(settings.effort * std::clamp(2.0 * static_cast<double>(n), 60.0, 800.0));
    relocation.seed = settings.seed;
    relocation.min_radius = min_radius;
    relocation.largest_radius = seeds.largest_radius;
    relocation.tolerance = seeds.tolerance;
    relocation.slack = containment.slack;
    const RelocationResult moved = relocate(spheres, coarse, unit_distance, relocation);
    result.iterations += moved.iterations;
    result.relocations = moved.accepted;

    tell("matching both surfaces", 0.0, 1.0);
    const SampleBlocks fine = samples_of(body, std::max<std::size_t>(8000, 300 * n), settings.seed + 1);
    settle_all(fine, 60, 1e-4);
    SymmetricLoss both(fine, unit_distance, spheres, body.moments, std::max<std::size_t>(10000, 60 * n));
    BlockMetric metric;
    VectorXd x = pack(spheres);
    MinimiserSettings polish;
    polish.iterations = 40;
    polish.tolerance = 3e-4;
    const MinimiserResult polished = minimise(
        x, lower_bounds(n, min_radius),
        [&](const VectorXd& at, VectorXd& gradient, bool refresh) {
            const double value = both.evaluate(at, gradient, refresh ? &metric : nullptr);
            if (refresh) metric.factorise(0.05);
            return value;
        },
        [&](VectorXd& q) { metric.apply(q); }, polish);
    spheres = unpack(x);
    result.iterations += polished.iterations;
    result.status = polished.converged ? FitStatus::converged : FitStatus::stopped_early;

    tell("matching volume and inertia", 0.0, 1.0);
    match_moments(spheres, body.moments, {settings.match_volume, settings.match_inertia, min_radius, 0.002});
    VectorXd gradient;
    both.evaluate(pack(spheres), gradient, nullptr);
    result.loss = 0.5 * (both.first() + both.second()) * body.frame.length * body.frame.length;
    result.spheres = body.frame.to_mesh(std::move(spheres));
    return result;
}

}  // namespace pelletlab::shapegen
