#include "shapegen/make_clump.hpp"

#include <chrono>
#include <memory>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/detail/known_union.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen {

namespace {

MassProperties chosen_mass(MassSource source, const MassProperties& target, const MassProperties& clump) {
    if (source == MassSource::target_mesh) return target;
    if (source == MassSource::union_of_spheres) return clump;
    return with_density(clump, target.mass / clump.volume);  // density matched: the union weighs what the body weighs
}

}  // namespace

RigidTemplate rigid_template(std::string name, std::span<const Sphere> spheres_mesh, const MassProperties& mass) {
    RigidTemplate result;
    result.name = std::move(name);
    result.mass_properties = mass;
    const Pose body = mass.body_in_mesh();
    for (const Sphere& sphere : spheres_mesh) result.spheres.push_back({body.to_body(sphere.centre), sphere.radius});
    result.bounding_radius = bounding_radius(result.spheres);
    return result;
}

MadeClump judged_clump(std::span<const Sphere> spheres_mesh, const TriangleMesh& body, const meshes::SignedDistance& exact, const ClumpSettings& settings) {
    if (!(settings.density > 0.0)) throw bad_input("the particle density is not positive", "give it like 1800 kg/m^3");
    MadeClump made;
    made.fit.spheres.assign(spheres_mesh.begin(), spheres_mesh.end());
    const detail::KnownUnion known(spheres_mesh);
    made.clump.quality = detail::measure_quality(known, body, exact);
    if (settings.measure_surface) {
        made.surface = detail::measure_surface(known, body, exact, {});
        made.clump.quality.surface = made.surface;
    }
    MassComparison& masses = made.clump.masses;
    masses = {meshes::mass_properties(body, settings.density), union_mass_properties(spheres_mesh, settings.density),
              sum_mass_properties(spheres_mesh, settings.density)};
    made.clump.mass_source = settings.mass_source;
    made.clump.rigid = rigid_template("clump", spheres_mesh, chosen_mass(settings.mass_source, masses.mesh, masses.of_union));
    made.cost = dem_cost(rigid_template("", spheres_mesh, masses.mesh).spheres, masses.mesh, settings.cost);
    made.relative_cost = made.cost.cost / dem_cost_of_shape_2(settings.density, settings.cost).cost;
    return made;
}

MadeClump make_clump(const TriangleMesh& body, const ClumpSettings& settings, const ProgressSink& progress,
                     std::shared_ptr<const meshes::SignedDistance> exact) {
    if (!(settings.density > 0.0)) throw bad_input("the particle density is not positive", "give it like 1800 kg/m^3");
    if (!(settings.voxel_fraction >= 0.0 && settings.voxel_fraction <= 0.25)) {
        throw bad_input("the voxel fraction is not between 0 and 1/4", "give 0 for exact distances, or for instance 1/64 of the smallest extent");
    }
    if (!(settings.most_cost >= 0.0))
        throw bad_input("the DEM cost allowed is negative or not a number", "give it in costs of the study's Shape 2, for instance 2");
    if (progress) progress({"computing the signed distance", 0.0, 1.0, "", 0.0, "", ""});
    auto last = std::chrono::steady_clock::now();
    const auto lap = [&last] {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last).count();
        last = now;
        return seconds;
    };
    if (!exact) exact = meshes::exact_signed_distance(body);
    std::unique_ptr<meshes::SignedDistance> grid;
    if (settings.voxel_fraction > 0.0)
        grid = meshes::grid_signed_distance(body, settings.voxel_fraction * bounding_box(body).sizes().minCoeff(), meshes::GridFill::exact_band, exact);
    const meshes::SignedDistance& search = grid ? *grid : *exact;
    MadeClump made;
    made.search_error = search.error_bound();
    made.times.distance = lap();

    if (settings.stop.any() || settings.most_cost > 0.0) {
        StoppedFit stopped = settings.stop.any()
                                 ? fit_to_criteria(body, search, *exact, settings.fit, settings.stop, progress)
                                 : fit_within_cost(body, search, *exact, settings.fit, settings.density, settings.most_cost, settings.cost, progress);
        made.fit = std::move(stopped.fit);
        made.attempts = stopped.attempts;
    } else {
        made.fit = fit_spheres(body, search, *exact, settings.fit, progress);
    }
    made.times.fit = lap();

    if (progress) progress({"measuring the fit", 0.0, 1.0, "", 0.0, "", ""});
    MadeClump judged = judged_clump(made.fit.spheres, body, *exact, settings);
    judged.fit = std::move(made.fit);
    judged.search_error = made.search_error;
    judged.attempts = made.attempts;
    judged.times = made.times;
    made = std::move(judged);
    if (settings.most_cost > 0.0 && made.relative_cost > settings.most_cost * (1.0 + 1e-9)) made.fit.status = FitStatus::criterion_not_met;
    made.clump.provenance.version = build_version();
    made.clump.provenance.git_hash = build_git_hash();
    made.clump.provenance.verb = "shape";
    made.clump.provenance.seed = settings.fit.seed;
    made.times.quality = lap();
    return made;
}

}  // namespace pelletlab::shapegen
