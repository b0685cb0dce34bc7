// What a clump feels like to its neighbours: roughness of its smooth faces, its normals, its rounded edges, and what a plane touches.
// Definitions and sources: ../docs/quality.md.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/clump_template.hpp"
#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen {

/// Heights of the union's surface over one smooth patch of the mesh, along the patch's normals, away from its sharp edges.
struct PatchRoughness {
    Vec3 mean_normal = Vec3::Zero();  ///< area-weighted, not normalised: length 1 for a flat patch, 0 for one that closes around the body
    double area = 0.0;                ///< [m²], of the patch on the mesh
    double mean = 0.0;                ///< [m], mean height; negative: the union lies inside the body
    double sq = 0.0;                  ///< [m], rms of the height about its mean (ISO 25178 Sq)
    double sz = 0.0;                  ///< [m], highest peak to deepest pit (ISO 25178 Sz)
    std::size_t points = 0;           ///< heights measured; 0: the patch has no place away from its edges, and the figures are zero
};

struct SurfaceReport : SurfaceFigures {
    std::vector<PatchRoughness> patches;                             ///< the largest first
    double union_volume = 0.0, sum_volume = 0.0, mesh_volume = 0.0;  ///< [m³]; sum: overlaps counted as often as they occur
};

struct SurfaceReportSettings {
    double sharp_angle = 0.5235987755982988;  ///< [rad], 30°: edges that bend more end a smooth patch
    double edge_band = 0.08;                  ///< heights keep this far from sharp edges, in smallest extents of the body
    double press = 0.0;                       ///< [m]; 0: 1/300 of the smallest extent
};

/// All in the frame of the mesh; `exact` is the exact distance of `body`, a closed mesh.
SurfaceReport measure_surface(std::span<const Sphere> spheres, const TriangleMesh& body, const meshes::SignedDistance& exact,
                              const SurfaceReportSettings& settings = {});

}  // namespace pelletlab::shapegen
