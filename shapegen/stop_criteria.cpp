#include "shapegen/stop_criteria.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/detail/symmetry_map.hpp"
#include "shapegen/make_clump.hpp"
#include "shapegen/quality.hpp"
#include "shapegen/surface_report.hpp"

namespace pelletlab::shapegen {

namespace {

constexpr std::uint32_t most_spheres = 2000;
constexpr std::uint32_t first_try = 12;  // the search for very few spheres takes longer than that for some more

void check(const StopCriteria& criteria) {
    const double wanted[] = {criteria.volume_error, criteria.symmetric_difference, criteria.inertia_error, criteria.mean, criteria.rms,
                             criteria.max,          criteria.edge_radius};
    for (const double value : wanted) {
        if (!(value >= 0.0)) throw usage_error("a stop criterion is negative or not a number", "give a positive value, or leave it out");
    }
    if (!criteria.any()) {
        throw usage_error("no stop criterion is given", "give the number of spheres, or an accuracy: volume, inertia, mean, rms, max or edge radius");
    }
    if (criteria.most_spheres == 0 || criteria.most_spheres > most_spheres)
        throw usage_error("a search up to " + std::to_string(criteria.most_spheres) + " spheres is out of reach", "allow 1 to 2000");
}

bool meets(const StoppedFit& made, const StopCriteria& criteria, const TriangleMesh& body, const meshes::SignedDistance& exact) {
    const auto met = [](double value, double limit) { return limit == 0.0 || value <= limit; };
    const FitQuality& q = made.quality;
    if (!met(std::abs(q.volume_error), criteria.volume_error) || !met(q.symmetric_difference, criteria.symmetric_difference) ||
        !met(q.inertia_error.cwiseAbs().maxCoeff(), criteria.inertia_error) || !met(q.both.mean, criteria.mean) || !met(q.both.rms, criteria.rms) ||
        !met(q.both.max, criteria.max)) {
        return false;
    }
    if (criteria.edge_radius == 0.0) return true;
    const double radius = measure_surface(made.fit.spheres, body, exact).edge_radius_mean;
    return std::isnan(radius) || radius <= criteria.edge_radius;  // no sharp edge: nothing to round
}

StoppedFit attempt(const TriangleMesh& body, const meshes::SignedDistance& search, const meshes::SignedDistance& exact, const FitSettings& settings,
                   std::uint32_t spheres, const ProgressSink& progress, bool judge = true) {
    StoppedFit made;
    FitSettings with = settings;
    with.sphere_count = spheres;
    if (with.symmetry_choice == SymmetryChoice::given) {
        const detail::SymmetryGroup group = detail::SymmetryGroup::of(with.symmetry);
        while (with.sphere_count < most_spheres && !group.can_hold(with.sphere_count)) ++with.sphere_count;
    }
    made.fit = fit_spheres(body, search, exact, with, progress);
    if (judge) made.quality = measure_quality(made.fit.spheres, body, exact);
    return made;
}

}  // namespace

StoppedFit fit_to_criteria(const TriangleMesh& body, const meshes::SignedDistance& search, const meshes::SignedDistance& exact, const FitSettings& settings,
                           const StopCriteria& criteria, const ProgressSink& progress) {
    check(criteria);
    StoppedFit best;
    bool met = false;
    std::uint32_t attempts = 0, too_few = 0, enough = 0;
    for (enough = std::min(first_try, criteria.most_spheres);; enough = std::min(2 * enough, criteria.most_spheres)) {
        best = attempt(body, search, exact, settings, enough, progress);
        ++attempts;
        met = meets(best, criteria, body, exact);
        if (met || enough >= criteria.most_spheres) break;
        too_few = enough;
    }
    while (met && enough - too_few > 1) {
        const std::uint32_t middle = too_few + (enough - too_few) / 2;
        StoppedFit made = attempt(body, search, exact, settings, middle, progress);
        ++attempts;
        if (meets(made, criteria, body, exact)) {
            enough = middle;
            best = std::move(made);
        } else {
            too_few = middle;
        }
    }
    best.attempts = attempts;
    if (!met) best.fit.status = FitStatus::criterion_not_met;
    return best;
}

namespace {

// The most spheres that are affordable, at least `least`; `first` is the number to begin with, `step` how many more to try next, and twice that. Nothing when
// not even the least is.
std::optional<StoppedFit> most_affordable(const std::function<StoppedFit(std::uint32_t)>& make, const std::function<bool(const StoppedFit&)>& affordable,
                                          std::uint32_t least, std::uint32_t first, std::uint32_t step) {
    std::optional<StoppedFit> best;
    std::uint32_t good = least - 1, bad = most_spheres + 1, next = first;
    while (bad - good > 1) {
        StoppedFit made = make(next);
        if (affordable(made)) {
            good = next;
            best = std::move(made);
        } else {
            bad = next;
        }
        if (bad > most_spheres) {
            next = std::min(good + step, most_spheres);
            step *= 2;
        } else {
            next = std::max(least, good + (bad - good) / 2);
        }
    }
    return best;
}

}  // namespace

StoppedFit fit_within_cost(const TriangleMesh& body, const meshes::SignedDistance& search, const meshes::SignedDistance& exact, const FitSettings& settings,
                           double density, double most_cost, const DemCostSettings& cost, const ProgressSink& progress) {
    if (!(most_cost > 0.0)) throw usage_error("the DEM cost allowed is not positive", "give it in costs of the study's Shape 2, for instance 2");
    const MassProperties mass = meshes::mass_properties(body, density);
    const double allowed = most_cost * dem_cost_of_shape_2(density, cost).cost;
    std::uint32_t attempts = 0;
    const auto affordable = [&](const StoppedFit& made) { return dem_cost(rigid_template("", made.fit.spheres, mass).spheres, mass, cost).cost <= allowed; };
    FitSettings with = settings;
    const auto make = [&](std::uint32_t spheres) {
        ++attempts;
        return attempt(body, search, exact, with, spheres, progress, false);
    };
    const auto judge = [&](std::optional<StoppedFit> made) {
        if (made) made->quality = measure_quality(made->fit.spheres, body, exact);
        return made;
    };
    std::optional<StoppedFit> best = judge(most_affordable(make, affordable, 1, first_try, first_try));
    if (!best) {
        best = attempt(body, search, exact, settings, 1, progress);
        best->fit.status = FitStatus::criterion_not_met;
    } else if (settings.most_contacts == 0 && settings.mode != FitMode::outside && settings.mode != FitMode::flat &&
               settings.symmetry_choice == SymmetryChoice::none) {
        // Spheres side by side on a face make it stiff and the time step short: fewer contacts there may buy more spheres than they cost in accuracy.
        if (with.press == 0.0) with.press = cost.press > 0.0 ? cost.press : equivalent_diameter(mass.volume) / 300.0;
        for (const std::uint32_t contacts : {6u, 3u}) {
            with.most_contacts = contacts;
            const auto least = static_cast<std::uint32_t>(best->fit.spheres.size());
            std::optional<StoppedFit> other = judge(most_affordable(make, affordable, least, least, std::max(1u, least / 8)));
            if (other && other->fit.status != FitStatus::limit_not_met && other->quality.both.rms < best->quality.both.rms) best = std::move(other);
        }
    }
    best->attempts = attempts;
    return *best;
}

}  // namespace pelletlab::shapegen
