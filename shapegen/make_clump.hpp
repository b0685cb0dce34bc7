// The whole way from a checked mesh to a clump template: distance, fit, quality, mass properties.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/clump_template.hpp"
#include "core/progress.hpp"
#include "core/triangle_mesh.hpp"
#include "shapegen/dem_cost.hpp"
#include "shapegen/fit.hpp"
#include "shapegen/stop_criteria.hpp"
#include "shapegen/surface_report.hpp"

namespace pelletlab::shapegen {

struct ClumpSettings {
    FitSettings fit;
    StopCriteria stop;       ///< any criterion given: as few spheres as meet it instead of fit.sphere_count
    double most_cost = 0.0;  ///< in DEM costs of the study's Shape 2; above 0 and no criterion given: as many spheres as that buys instead of fit.sphere_count;
                             ///< with criteria: as few as meet them, and status criterion_not_met when those cost more
    DemCostSettings cost;
    bool measure_surface = true;  ///< fill MadeClump::surface
    double density = 1800.0;      ///< [kg/m³]
    MassSource mass_source = MassSource::target_mesh;
    double voxel_fraction = 1.0 / 32.0;  ///< voxel of the search grid / smallest extent of the body; 0: the fit asks the exact distance instead
};

/// Wall-clock seconds of the stages; those of the fit itself stand in FitResult::times.
struct ClumpTimes {
    double distance = 0.0, fit = 0.0, quality = 0.0;
};

struct MadeClump {
    ClumpTemplate clump;    ///< spheres in the body frame (centre of mass, principal axes)
    FitResult fit;          ///< spheres in the mesh frame
    SurfaceReport surface;  ///< roughness, normals, edges, plane contacts
    DemCost cost;
    double relative_cost = 0.0;  ///< / that of the study's Shape 2 at the same density
    double search_error = 0.0;   ///< [m], bound of the error of the distance that the search used
    std::uint32_t attempts = 1;  ///< fits made to meet a criterion
    ClumpTimes times;
};

/// `body` closed and outward oriented (meshes::require_closed_body). `exact`: its exact distance, where that is known already.
MadeClump make_clump(const TriangleMesh& body, const ClumpSettings& settings, const ProgressSink& progress = {},
                     std::shared_ptr<const meshes::SignedDistance> exact = nullptr);

/// Any spheres in the mesh frame (of another method, of a file), judged and weighed as make_clump does with its own. Of `settings` the density, mass source,
/// cost and measure_surface count; times and fit statistics stay empty. `exact`: the exact distance of `body`.
MadeClump judged_clump(std::span<const Sphere> spheres_mesh, const TriangleMesh& body, const meshes::SignedDistance& exact, const ClumpSettings& settings);

/// Moves a set of mesh-frame spheres into the body frame of `mass` and wraps them up as a template.
RigidTemplate rigid_template(std::string name, std::span<const Sphere> spheres_mesh, const MassProperties& mass);

}  // namespace pelletlab::shapegen
