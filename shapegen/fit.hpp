// Mesh → clump: spheres whose union has the same surface as the body, by least squares on the signed distance.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen {

struct FitSettings {
    std::uint32_t sphere_count = 24;  ///< exactly so many come out
    double min_radius = 0.0;          ///< [m]; 0: no limit
    bool match_volume = true;         ///< one common radius offset at the end makes union volume = mesh volume
    bool match_inertia = true;        ///< a shift and a stretch of the centres by at most 0.2 % give the union the mesh's centre and principal inertia
    double effort = 1.0;              ///< scales the number of spheres tried elsewhere: time grows with it, the error falls slowly
    std::uint64_t seed = 1;
};

enum class FitStatus { converged, stopped_early };

struct FitResult {
    std::vector<Sphere> spheres;  ///< in the frame of the mesh
    FitStatus status = FitStatus::converged;
    double loss = 0.0;              ///< [m²], mean squared distance at the end, average of both directions
    std::uint32_t iterations = 0;   ///< of the minimiser, all stages
    std::uint32_t relocations = 0;  ///< spheres that found a better place elsewhere
};

/// `body` must be a closed mesh; `distance` its signed distance (the grid, for speed). Deterministic for a seed, whatever the number of threads.
FitResult fit_spheres(const TriangleMesh& body, const meshes::SignedDistance& distance, const FitSettings& settings, const ProgressSink& progress = {});

}  // namespace pelletlab::shapegen
