#include "shapegen/detail/symmetric_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/progress.hpp"
#include "core/random.hpp"
#include "shapegen/detail/lbfgs.hpp"
#include "shapegen/detail/medial_balls.hpp"
#include "shapegen/detail/settle.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr double snap = 0.4;  // a ball is moved onto a mirror plane when that is nearer than this share of the spheres' spacing

// Fills a state up to a number of spheres, orbit by orbit.
class OrbitFiller {
public:
    OrbitFiller(const SymmetryGroup& group, const SampleBlocks& samples, const meshes::SignedDistance& distance, const SeedSettings& settings)
        : group_(group), samples_(samples), distance_(distance), settings_(settings) {
        // Which numbers of spheres are whole orbits, with the centre still free and without it.
        for (const bool with_centre : {false, true}) {
            std::vector<std::uint8_t>& reached = with_centre ? with_centre_ : without_centre_;
            reached.assign(settings.count + 1, 0);
            reached[0] = 1;
            for (const auto& place : group.places) {
                const std::size_t size = place.moves.size();
                if (place.dimension == 0) continue;
                for (std::size_t n = size; n <= settings.count; ++n) reached[n] = reached[n] || reached[n - size] ? 1 : 0;
            }
            if (!with_centre) continue;
            for (std::size_t n = settings.count; n >= 1; --n) {
                if (has_centre_place() && without_centre_[n - 1]) reached[n] = 1;
            }
        }
    }

    bool has_centre_place() const {
        return std::any_of(group_.places.begin(), group_.places.end(), [](const auto& place) { return place.dimension == 0; });
    }

    // Gaps of the samples to all images of these generators.
    std::vector<double> gaps_of(const std::vector<Generator>& generators) const {
        std::vector<double> gap(samples_.size(), std::numeric_limits<double>::infinity());
        for (const Generator& generator : generators) add(generator, gap);
        return gap;
    }
    void add(const Generator& generator, std::vector<double>& gap) const {
        for (const std::size_t move : group_.places[generator.place].moves) {
            const Vec3 c = group_.elements[move] * generator.sphere.centre;
            for (std::size_t k = 0; k < gap.size(); ++k) gap[k] = std::min(gap[k], (samples_.points[k] - c).norm() - generator.sphere.radius);
        }
    }

    // The medial ball at a sample, on a place that it is near to and that leaves a number of spheres that orbits can make up.
    Generator ball_at(std::size_t sample, std::size_t left, bool centre_taken, double spacing) const {
        const Vec3 &p = samples_.points[sample], &n = samples_.normals[sample];
        const double smallest = std::max(settings_.min_radius, 2.0 * settings_.tolerance);
        const double r = std::max(smallest, medial_radius(distance_, p, n, settings_.largest_radius, settings_.tolerance));
        const Vec3 centre = p - r * n;
        Generator best;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = group_.places.size(); k-- > 0;) {  // the most special place first
            const auto& place = group_.places[k];
            const std::size_t size = place.moves.size();
            const bool is_centre = place.dimension == 0;
            if (size > left || (is_centre && centre_taken)) continue;
            if (!(centre_taken || is_centre ? without_centre_ : with_centre_)[left - size]) continue;
            const Vec3 on = group_.brought_to(centre, k);
            double off = std::numeric_limits<double>::infinity();
            for (const Mat3& element : group_.elements) off = std::min(off, (element * centre - on).norm());
            // A place of fewer dimensions wins while it is near; else the nearest one.
            if (off < snap * spacing) off = 1e-3 * static_cast<double>(place.dimension);
            if (off < least) {
                least = off;
                best = {k, {on, r}};
            }
        }
        // On its new place the ball is as large as fits there.
        best.sphere.radius = std::max(smallest, std::min(settings_.largest_radius, settings_.tolerance - distance_.value(best.sphere.centre)));
        return best;
    }

    // `first` draws the first sample; all others are the worst ones.
    void fill(std::vector<Generator>& generators, std::size_t left, const std::vector<std::size_t>& first) const {
        std::vector<double> gap = gaps_of(generators);
        bool centre_taken = std::any_of(generators.begin(), generators.end(), [&](const Generator& g) { return group_.places[g.place].dimension == 0; });
        const double spacing = std::sqrt(6.0 / static_cast<double>(settings_.count));  // a body of volume 1 has an area of about 6
        std::size_t drawn = 0;
        while (left > 0) {
            const std::size_t at = drawn < first.size() ? first[drawn++] : static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
            const Generator next = ball_at(at, left, centre_taken, spacing);
            left -= group_.places[next.place].moves.size();
            centre_taken = centre_taken || group_.places[next.place].dimension == 0;
            add(next, gap);
            generators.push_back(next);
        }
    }

private:
    const SymmetryGroup& group_;
    const SampleBlocks& samples_;
    const meshes::SignedDistance& distance_;
    SeedSettings settings_;
    std::vector<std::uint8_t> without_centre_, with_centre_;
};

}  // namespace

std::vector<std::size_t> SymmetricSpheres::places() const {
    std::vector<std::size_t> result;
    for (const Generator& generator : generators) result.push_back(generator.place);
    return result;
}

std::vector<Sphere> SymmetricSpheres::spheres() const {
    std::vector<Sphere> result;
    for (const Generator& generator : generators) result.push_back(generator.sphere);
    return result;
}

SymmetricSpheres seed_orbits(const SymmetryGroup& group, const SampleBlocks& samples, const meshes::SignedDistance& distance, const SeedSettings& settings) {
    SymmetricSpheres state;
    // The first ball: the largest one among a few points.
    const std::size_t tries = std::min<std::size_t>(samples.size(), 64);
    double largest = -1.0;
    std::size_t start = 0;
    for (std::size_t k = 0; k < tries; ++k) {
        const std::size_t at = k * samples.size() / tries;
        const double r = medial_radius(distance, samples.points[at], samples.normals[at], settings.largest_radius, settings.tolerance);
        if (r > largest) {
            largest = r;
            start = at;
        }
    }
    OrbitFiller(group, samples, distance, settings).fill(state.generators, settings.count, {start});
    return state;
}

double settle_orbits(const SymmetryGroup& group, SymmetricSpheres& state, const SampleBlocks& samples, const Containment& containment, std::uint32_t iterations,
                     double tolerance, double min_radius, double give_up_above, std::uint32_t& iterations_done) {
    const SymmetryMap map(group, state.places());
    GapLoss loss(samples, map.expand(state.spheres()));
    loss.contain(containment);
    BlockMetric of_all, metric;
    VectorXd slope;
    const Objective objective = [&](const VectorXd& y, VectorXd& gradient, bool refresh) {
        const double value = loss.evaluate(map.expand(y), &slope, refresh ? &of_all : nullptr);
        gradient = map.reduce(slope);
        if (refresh) {
            metric = map.reduce(of_all);
            metric.factorise(0.05);
        }
        return value;
    };
    MinimiserSettings minimiser;
    minimiser.iterations = iterations;
    minimiser.tolerance = tolerance;
    minimiser.give_up_above = give_up_above;
    VectorXd y = pack(state.spheres());
    const MinimiserResult result = minimise(
        y, lower_bounds(state.generators.size(), min_radius), objective, [&](VectorXd& q) { metric.apply(q); }, minimiser);
    iterations_done += result.iterations;
    const std::vector<Sphere> moved = unpack(y);
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const Mat3& onto = group.places[state.generators[i].place].onto;
        state.generators[i].sphere = {onto * moved[i].centre, moved[i].radius};
    }
    return result.loss;
}

RelocationResult relocate_orbits(const SymmetryGroup& group, SymmetricSpheres& state, const SampleBlocks& samples, const meshes::SignedDistance& distance,
                                 const RelocationSettings& settings) {
    RelocationResult result;
    const Containment containment{&distance, settings.slack};
    std::size_t all = 0;
    for (const Generator& generator : state.generators) all += group.places[generator.place].moves.size();
    const OrbitFiller filler(group, samples, distance, {all, settings.min_radius, settings.largest_radius, settings.tolerance});
    SymmetricSpheres best = state;
    double loss = settle_orbits(group, best, samples, containment, 10, 1e-3, settings.min_radius, std::numeric_limits<double>::infinity(), result.iterations);
    for (; result.trials < settings.trials; ++result.trials) {
        throw_if_interrupted();
        RandomStream random(settings.seed, 0x0b17000000000u + result.trials);
        SymmetricSpheres trial = best;
        std::size_t freed = 0;
        const std::size_t leave = std::min<std::size_t>(trial.generators.size(), random.uniform() < 0.6 ? 1 : 2);
        for (std::size_t k = 0; k < leave; ++k) {
            const auto which = static_cast<std::size_t>(random.uniform() * static_cast<double>(trial.generators.size()));
            freed += group.places[trial.generators[which].place].moves.size();
            trial.generators.erase(trial.generators.begin() + static_cast<std::ptrdiff_t>(which));
        }
        // The first one comes to a sample drawn by the fourth power of the gap without those that left.
        const std::vector<double> gap = filler.gaps_of(trial.generators);
        std::vector<double> below(gap.size());
        double running = 0.0;
        for (std::size_t k = 0; k < gap.size(); ++k) {
            const double g = std::min(1.0, std::max(0.0, gap[k]));
            below[k] = running += g * g * g * g;
        }
        const auto at = static_cast<std::size_t>(std::lower_bound(below.begin(), below.end(), random.uniform() * running) - below.begin());
        filler.fill(trial.generators, freed, {std::min(at, gap.size() - 1)});
        const double after = settle_orbits(group, trial, samples, containment, settings.local_iterations, 2e-3, settings.min_radius, loss, result.iterations);
        if (after >= loss) continue;
        loss = after;
        best = std::move(trial);
        ++result.accepted;
    }
    state = std::move(best);
    result.loss = loss;
    return result;
}

}  // namespace pelletlab::shapegen::detail
