#include "shapegen/fit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/detail/body_frame.hpp"
#include "shapegen/detail/contact_limit.hpp"
#include "shapegen/detail/edge_band.hpp"
#include "shapegen/detail/feature_edges.hpp"
#include "shapegen/detail/few_spheres.hpp"
#include "shapegen/detail/match_moments.hpp"
#include "shapegen/detail/modes.hpp"
#include "shapegen/detail/one_sided.hpp"
#include "shapegen/detail/relocation.hpp"
#include "shapegen/detail/seeding.hpp"
#include "shapegen/detail/settle.hpp"
#include "shapegen/detail/smooth_patches.hpp"
#include "shapegen/detail/surface_samples.hpp"
#include "shapegen/detail/symmetric_loss.hpp"
#include "shapegen/detail/symmetric_search.hpp"
#include "shapegen/detail/true_loss.hpp"

namespace pelletlab::shapegen {

namespace {

using namespace detail;

constexpr std::uint32_t most_spheres = 2000;

// Beside sharp edges gaps are large whatever the fit does, and a plain mean square spends spheres there that smooth faces need: the faces come out rough. So
// where there are edges, the surface apart from them weighs more, and the union's own surface, which has little area at the edges, counts more than the
// body's. On the pellet's cylinder that lowers the roughness by less than 1 % at 24 spheres, 4 to 5 % at 82 and 9 % at 200; it costs up to 1 % of the rms and
// raises the largest distance, at the edges, by 11 to 16 %. Few spheres have none to spare: both weights grow in with their number.
constexpr double sharp_angle = std::numbers::pi / 6.0;  // as in the surface report
constexpr double edge_band = 0.08;                      // × smallest extent, as there
constexpr double weight_of_faces = 1.9;
constexpr double second_with_faces = 1.4;  // SymmetricTerms::second
constexpr double least_edges = 0.05;       // share of the surface in that band: below it the body counts as smooth
constexpr double first_spheres = 20, spheres_for_full_weight = 110;

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
    if (!(settings.poke_out >= 0.0)) throw bad_input("the allowed poke-out is negative or not a number", "give 0 or a positive length");
    if (!(settings.press >= 0.0))
        throw bad_input("the depth of the pressed plane is negative or not a number", "give 0 for the usual one, or a positive length");
    if (settings.mode == FitMode::outside && settings.most_contacts > 0) {
        throw bad_input("a clump that covers its body cannot hold spheres back from a plane", "leave out the limit of contacts, or choose another mode");
    }
    if (!(settings.effort >= 0.0)) throw bad_input("the effort is negative or not a number", "give 1 for the usual search, 0 for none");
}

// Gaps of a good fit, measured on cylinders; only tells what counts as small.
double expected_gap(std::size_t spheres) {
    return 0.019 * std::pow(24.0 / static_cast<double>(spheres), 0.68);
}

// Relocation judges one direction on few samples and ends where none of its trials gains. The fine samples then move all spheres, and how far they may reach
// out is set anew; after that it gains again. With three rounds the trilobe's rms at 200 spheres falls by 5 % (mean of four seeds), the ring's and the
// cylinder's do not; at 82 spheres a second round gains nothing on the cylinder.
std::uint32_t rounds_of_search(std::size_t spheres) {
    return spheres < 128 ? 1 : 3;
}

struct WeighedBand {
    EdgeBand band;
    double faces = 1.0;   // weight of the surface apart from it
    double second = 1.0;  // SymmetricTerms::second
};

// Samples of the part of the surface that the symmetry repeats; with the sharp edges, where the largest distances are, if wanted.
SampleBlocks samples_of(const Body& body, std::size_t count, std::uint64_t seed, const SymmetryGroup& group, const std::optional<WeighedBand>& weighed,
                        bool edges = false) {
    SurfaceSamples samples = sample_surface(body.mesh, count, seed);
    if (edges) add_edge_points(samples, body.mesh, sharp_angle, std::sqrt(samples.area / static_cast<double>(count)));
    if (group.elements.size() > 1) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < samples.points.size(); ++k) {
            if (!group.in_domain(samples.points[k])) continue;
            samples.points[kept] = samples.points[k];
            samples.normals[kept++] = samples.normals[k];
        }
        samples.points.resize(kept);
        samples.normals.resize(kept);
    }
    SampleBlocks blocks = make_blocks(std::move(samples));
    if (weighed) weigh_apart_from_edges(blocks, weighed->band, weighed->faces);
    return blocks;
}

// From 1 to the full weight.
double grown_in(double weight, std::size_t spheres) {
    return 1.0 + (weight - 1.0) * std::clamp((static_cast<double>(spheres) - first_spheres) / (spheres_for_full_weight - first_spheres), 0.0, 1.0);
}

// The band that weighs less, in the modes that charge the mean square, where there are sharp edges.
std::optional<WeighedBand> light_band(const Body& body, FitMode mode, std::size_t spheres) {
    if (mode != FitMode::mean && mode != FitMode::flat) return {};
    const SmoothPatches patches = smooth_patches(body.mesh, sharp_angle);
    const double width = edge_band * body.smallest_extent;
    double length = 0.0, area = 0.0;
    for (const SharpEdge& edge : patches.edges) length += (edge.b - edge.a).norm();
    for (std::size_t f = 0; f < body.mesh.faces.size(); ++f)
        area += 0.5 * (body.mesh.corner(f, 1) - body.mesh.corner(f, 0)).cross(body.mesh.corner(f, 2) - body.mesh.corner(f, 0)).norm();
    if (2.0 * width * length < least_edges * area) return {};
    return WeighedBand{EdgeBand(patches.edges, width), grown_in(weight_of_faces, spheres), grown_in(second_with_faces, spheres)};
}

auto mode_stage(FitMode mode) {
    switch (mode) {
        case FitMode::minimax:
            return fit_minimax;
        case FitMode::inside:
            return fit_inside;
        case FitMode::outside:
            return fit_outside;
        case FitMode::flat:
            return fit_flat;
        case FitMode::mean:
            break;
    }
    return fit_mean;
}

// Numbers near n that whole orbits make up, for the remedy of an error.
std::string numbers_near(const SymmetryGroup& group, std::uint32_t n) {
    std::uint32_t below = n, above = n;
    while (below > 0 && !group.can_hold(below)) --below;
    while (above < most_spheres && !group.can_hold(above)) ++above;
    return (below > 0 ? std::to_string(below) + " or " : std::string()) + std::to_string(above);
}

// The symmetry to impose: what was asked for, or as much of the body's own as the number of spheres allows.
Symmetry chosen_symmetry(const TriangleMesh& mesh, const meshes::SignedDistance& exact, const FitSettings& settings) {
    if (settings.symmetry_choice == SymmetryChoice::none) return {};
    if (settings.symmetry_choice == SymmetryChoice::given) {
        const SymmetryGroup group = SymmetryGroup::of(settings.symmetry);
        if (!group.can_hold(settings.sphere_count)) {
            throw bad_input("no clump of " + std::to_string(settings.sphere_count) + " spheres has the symmetry " + describe(settings.symmetry),
                            "ask for " + numbers_near(group, settings.sphere_count) + " spheres, or for less symmetry");
        }
        return settings.symmetry;
    }
    Symmetry symmetry = symmetry_for(find_symmetry(mesh, exact), settings.sphere_count);
    while (!SymmetryGroup::of(symmetry).can_hold(settings.sphere_count)) {
        if (!symmetry.mirrors.empty()) {
            symmetry.mirrors.pop_back();
        } else {
            std::uint32_t part = 2;  // the smallest divisor leaves the largest subgroup
            while (symmetry.fold % part != 0) ++part;
            symmetry.fold /= part;
        }
    }
    return symmetry;
}

// Rings of a body of revolution: the fold that symmetry_for() proposes and the nearest others that leave little over for the axis. Which one is best, a fit
// tells.
std::vector<Symmetry> ring_symmetries(const FoundSymmetry& found, std::uint32_t spheres) {
    const Symmetry proposed = symmetry_for(found, spheres);
    std::vector<std::pair<double, std::uint32_t>> order;
    for (std::uint32_t fold = 2; fold <= std::min<std::uint32_t>(32, std::max<std::uint32_t>(2, spheres)); ++fold) {
        const double misfit = std::abs(std::log(static_cast<double>(fold) / proposed.fold));
        if (fold == proposed.fold || (spheres % fold <= 2 && misfit < 0.8)) order.emplace_back(misfit, fold);
    }
    std::sort(order.begin(), order.end());
    std::vector<Symmetry> result;
    for (const auto& [misfit, fold] : order) {
        Symmetry candidate = proposed;
        candidate.fold = fold;
        if (SymmetryGroup::of(candidate).can_hold(spheres)) result.push_back(std::move(candidate));
        if (result.size() == 5) break;
    }
    return result;
}

class Clock {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

FitResult fit_spheres(const TriangleMesh& mesh, const meshes::SignedDistance& search, const meshes::SignedDistance& exact, const FitSettings& settings,
                      const ProgressSink& progress) {
    const auto tell = [&](const char* stage) {
        if (progress) progress({stage, 0.0, 1.0, "", 0.0, "", ""});
    };
    Clock clock;
    const Body body = unit_body(mesh);
    check(settings, body);
    if (settings.symmetry_choice == SymmetryChoice::own) {
        const FoundSymmetry found = find_symmetry(mesh, exact);
        const std::vector<Symmetry> rings = found.revolution ? ring_symmetries(found, settings.sphere_count) : std::vector<Symmetry>{};
        FitResult best;
        FitTimes times;
        for (const Symmetry& symmetry : rings) {
            FitSettings with = settings;
            with.symmetry_choice = SymmetryChoice::given;
            with.symmetry = symmetry;
            FitResult one = fit_spheres(mesh, search, exact, with, progress);
            times = {times.seeds + one.times.seeds, times.search + one.times.search, times.finish + one.times.finish};
            if (best.spheres.empty() || one.loss < best.loss) best = std::move(one);
        }
        best.times = times;
        if (!rings.empty()) return best;
    }
    const UnitDistance unit_distance(search, body.frame), unit_exact(exact, body.frame);
    const std::size_t n = settings.sphere_count;
    // Spheres much smaller than the gaps fit the noise of the samples, not the body.
    const double min_radius = std::max(settings.min_radius / body.frame.length, std::min(2.0 * expected_gap(n), 0.05 * body.smallest_extent));
    FitResult result;
    result.symmetry = chosen_symmetry(mesh, exact, settings);
    const SymmetryGroup group = SymmetryGroup::of(result.symmetry);
    const bool symmetric = group.elements.size() > 1, few = !symmetric && n <= few_spheres;
    const bool minimax = settings.mode == FitMode::minimax;

    const std::optional<WeighedBand> band = light_band(body, settings.mode, n);
    // Where the last stage charges the mean square anyway, fewer samples find the same fit.
    const std::size_t coarse_each = settings.mode == FitMode::mean || settings.mode == FitMode::flat ? 100 : 150;
    tell("seeding spheres");
    const SampleBlocks coarse = samples_of(body, std::max({std::size_t{3600}, coarse_each * n, 1000 * group.elements.size()}), settings.seed, group, band);
    SeedSettings seeds;
    seeds.count = n;
    seeds.min_radius = min_radius;
    seeds.largest_radius = 0.5 * body.smallest_extent;
    seeds.tolerance = few ? 0.02 * body.smallest_extent : std::min(0.3 * expected_gap(n), 0.02 * body.smallest_extent);
    std::vector<Sphere> spheres;
    SymmetricSpheres orbits;
    if (symmetric) {
        orbits = seed_orbits(group, coarse, unit_distance, seeds);
    } else if (!few) {
        spheres = seed_by_gaps(coarse, unit_distance, seeds);
    }
    result.times.seeds = clock.lap();

    tell("fitting spheres");
    Containment containment{&unit_distance, 0.0};
    const auto settle_all = [&](const SampleBlocks& samples, std::uint32_t iterations, double tolerance) {
        if (symmetric) spheres = SymmetryMap(group, orbits.places()).expand(orbits.spheres());
        GapLoss loss(samples, spheres);
        // Reaching out by twice the usual gap is what a good fit does at edges.
        loss.evaluate(pack(spheres), nullptr, nullptr);
        containment.slack = 2.0 * std::sqrt(loss.gap_part());
        if (symmetric) {
            settle_orbits(group, orbits, samples, containment, iterations, tolerance, min_radius, std::numeric_limits<double>::infinity(), result.iterations);
            spheres = SymmetryMap(group, orbits.places()).expand(orbits.spheres());
            return;
        }
        loss.contain(containment);
        const MinimiserResult settled = settle(loss, {iterations, tolerance, min_radius, 0.05});
        loss.copy_spheres(spheres);
        result.iterations += settled.iterations;
    };
    if (!few) settle_all(coarse, 60, 1e-3);

    tell("moving spheres to better places");
    RelocationSettings relocation;
    const std::uint32_t rounds = rounds_of_search(n);
    const double trials = std::clamp(1.2 * static_cast<double>(n), 40.0, 500.0) * (rounds > 1 ? 2.0 / 3.0 : 1.0);
    relocation.trials = static_cast<std::uint32_t>(settings.effort * trials);
    relocation.seed = settings.seed;
    relocation.min_radius = min_radius;
    relocation.largest_radius = seeds.largest_radius;
    relocation.tolerance = seeds.tolerance;
    SampleBlocks fine = samples_of(body, std::max({std::size_t{8000}, 300 * n, 1000 * group.elements.size()}), settings.seed + 1, group, band,
                                   minimax || settings.mode == FitMode::outside);
    const std::size_t points = std::max<std::size_t>(10000, (minimax ? 120 : 60) * n);
    MatchSettings match{settings.match_volume, settings.match_inertia, min_radius, 0.002};
    FewSpheresResult found;
    if (few) {
        const ModeContext plain{body.mesh, unit_distance, unit_exact, body.moments, min_radius, 0.0, nullptr, 1.0};
        found = fit_few(n, coarse, fine, plain, points, relocation, match);
        spheres = found.spheres;
        for (std::vector<Sphere>& fewer : found.fewer) result.fewer.push_back(body.frame.to_mesh(std::move(fewer)));
        result.iterations += found.iterations;
        result.relocations = found.relocations;
    } else {
        for (std::uint32_t round = 0; round < rounds; ++round) {
            relocation.seed = settings.seed + (std::uint64_t{round} << 32);
            relocation.slack = containment.slack;
            const RelocationResult moved =
                symmetric ? relocate_orbits(group, orbits, coarse, unit_distance, relocation) : relocate(spheres, coarse, unit_distance, relocation);
            result.iterations += moved.iterations;
            result.relocations += moved.accepted;
            settle_all(fine, 60, 1e-4);
        }
    }
    result.times.search = clock.lap();

    tell("matching both surfaces");
    const SymmetryMap map(group, orbits.places());
    const ModeContext context{body.mesh,
                              unit_distance,
                              unit_exact,
                              body.moments,
                              min_radius,
                              settings.poke_out / body.frame.length,
                              symmetric ? &map : nullptr,
                              band ? band->second : 1.0};
    MinimiserResult polished;
    if (few && settings.mode == FitMode::mean) {
        polished.converged = found.converged;
        match.centre_and_inertia = match.centre_and_inertia && settings.most_contacts > 0;  // done already, as far as it may go
    } else {
        polished = mode_stage(settings.mode)(spheres, context, fine, points);
    }
    const ContactLimit limit{settings.most_contacts, (settings.press > 0.0 ? settings.press / body.frame.length : body.smallest_extent / 300.0)};
    if (limit.most > 0) polished.iterations += fit_within_contacts(spheres, context, limit, fine, points).iterations;
    result.iterations += polished.iterations;
    result.status = polished.converged ? FitStatus::converged : FitStatus::stopped_early;

    const bool one_sided = settings.mode == FitMode::inside || settings.mode == FitMode::outside;
    if (!one_sided) {
        tell("matching volume and inertia");
        match_moments(spheres, body.moments, match);
        restore_symmetry(spheres, context);
        match.centre_and_inertia = false;  // from here on radii grow or shrink together only: that keeps level poles level and contacts few
    }
    if (settings.mode == FitMode::flat) level_poles(spheres, context);
    if (limit.most > 0 && !hold_contacts(spheres, context, limit)) result.status = FitStatus::limit_not_met;
    if (!one_sided && (symmetric || limit.most > 0 || settings.mode == FitMode::flat)) match_moments(spheres, body.moments, match);

    result.loss = true_loss(spheres, fine, few ? static_cast<const meshes::SignedDistance&>(unit_exact) : unit_distance, few ? fine.size() : points) *
                  body.frame.length * body.frame.length;
    result.poke_out = std::max(0.0, largest_poke_out(spheres, unit_exact) + unit_exact.error_bound()) * body.frame.length;
    result.spheres = body.frame.to_mesh(std::move(spheres));
    result.times.finish = clock.lap();
    return result;
}

}  // namespace pelletlab::shapegen
