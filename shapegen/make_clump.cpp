#include "shapegen/make_clump.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/quality.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen {

namespace {

MassProperties chosen_mass(MassSource source, const TriangleMesh& body, std::span<const Sphere> spheres, double density) {
    const MassProperties target = meshes::mass_properties(body, density);
    if (source == MassSource::target_mesh) return target;
    const MassProperties clump = union_mass_properties(spheres, density);
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

ClumpTemplate judged_template(std::span<const Sphere> spheres_mesh, const TriangleMesh& body, const meshes::SignedDistance& exact, double density,
                              MassSource mass_source) {
    if (!(density > 0.0)) throw bad_input("the particle density is not positive", "give it like 1800 kg/m^3");
    ClumpTemplate clump;
    clump.quality = measure_quality(spheres_mesh, body, exact);
    clump.mass_source = mass_source;
    clump.rigid = rigid_template("clump", spheres_mesh, chosen_mass(mass_source, body, spheres_mesh, density));
    return clump;
}

MadeClump make_clump(const TriangleMesh& body, const ClumpSettings& settings, const ProgressSink& progress) {
    if (!(settings.density > 0.0)) throw bad_input("the particle density is not positive", "give it like 1800 kg/m^3");
    if (!(settings.voxel_fraction >= 0.0 && settings.voxel_fraction <= 0.25)) {
        throw bad_input("the voxel fraction is not between 0 and 1/4", "give 0 for exact distances, or for instance 1/64 of the smallest extent");
    }
    if (progress) progress({"computing the signed distance", 0.0, 1.0, "", 0.0, "", ""});
    const auto exact = meshes::exact_signed_distance(body);
    MadeClump made;
    if (settings.voxel_fraction > 0.0) {
        const auto grid = meshes::grid_signed_distance(body, settings.voxel_fraction * bounding_box(body).sizes().minCoeff(), meshes::GridFill::openvdb);
        made.fit = fit_spheres(body, *grid, settings.fit, progress);
    } else {
        made.fit = fit_spheres(body, *exact, settings.fit, progress);
    }
    if (progress) progress({"measuring the fit", 0.0, 1.0, "", 0.0, "", ""});
    made.clump = judged_template(made.fit.spheres, body, *exact, settings.density, settings.mass_source);
    made.clump.provenance.version = build_version();
    made.clump.provenance.git_hash = build_git_hash();
    made.clump.provenance.verb = "shape";
    made.clump.provenance.seed = settings.fit.seed;
    return made;
}

}  // namespace pelletlab::shapegen
