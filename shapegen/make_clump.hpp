// The whole way from a checked mesh to a clump template: distance, fit, quality, mass properties.
#pragma once

#include <span>
#include <string>

#include "core/clump_template.hpp"
#include "core/progress.hpp"
#include "core/triangle_mesh.hpp"
#include "shapegen/fit.hpp"

namespace pelletlab::shapegen {

struct ClumpSettings {
    FitSettings fit;
    double density = 1800.0;  ///< [kg/m³]
    MassSource mass_source = MassSource::target_mesh;
    double voxel_fraction = 1.0 / 32.0;  ///< voxel of OpenVDB's search grid / smallest extent of the body; 0: the fit asks the exact distance instead
};

struct MadeClump {
    ClumpTemplate clump;  ///< spheres in the body frame (centre of mass, principal axes)
    FitResult fit;        ///< spheres in the mesh frame
};

/// `body` closed and outward oriented (meshes::require_closed_body).
MadeClump make_clump(const TriangleMesh& body, const ClumpSettings& settings, const ProgressSink& progress = {});

/// Any spheres in the mesh frame (of another method, of a file) as a template, judged and weighed as make_clump does. `exact`: the exact distance of `body`.
ClumpTemplate judged_template(std::span<const Sphere> spheres_mesh, const TriangleMesh& body, const meshes::SignedDistance& exact, double density,
                              MassSource mass_source);

/// Moves a set of mesh-frame spheres into the body frame of `mass` and wraps them up as a template.
RigidTemplate rigid_template(std::string name, std::span<const Sphere> spheres_mesh, const MassProperties& mass);

}  // namespace pelletlab::shapegen
