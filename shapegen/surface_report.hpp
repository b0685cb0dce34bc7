// What a clump feels like to its neighbours: roughness of its smooth faces, its normals, its rounded edges, and what a plane touches.
// Definitions and sources: ../docs/shape-quality.md.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

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

struct SurfaceReport {
    std::vector<PatchRoughness> patches;      ///< the largest first
    double flat_sq = 0.0, flat_sz = 0.0;      ///< [m], of all flat patches together, each about its own mean (sz: the worst)
    double curved_sq = 0.0, curved_sz = 0.0;  ///< [m], of all others

    double normal_mean = 0.0;  ///< [rad], angle between the union's normal and the body's at the nearest point, mean over the exposed outer area
    double normal_rms = 0.0;   ///< [rad]
    double normal_p95 = 0.0;   ///< [rad]

    /// Sharp convex edges: way from the edge along its bisector to the union, and the radius of a rounded edge with the same gap,
    /// gap / (1/sin(θ/2) − 1) at the inner angle θ. NaN for a body without such edges.
    double edge_gap_mean = 0.0, edge_gap_max = 0.0;        ///< [m]
    double edge_radius_mean = 0.0, edge_radius_max = 0.0;  ///< [m]

    /// Support function: how much farther a plane rests from the centre on the union than on the body, over all directions.
    double support_mean = 0.0, support_rms = 0.0, support_max = 0.0;  ///< [m], max of the absolute value

    /// Spheres that touch a plane pressed in by `press`.
    double press = 0.0;             ///< [m]
    double contacts_on_flat = 0.0;  ///< mean over the flat faces; NaN without any
    std::size_t most_on_flat = 0;   ///< on one of them
    double contacts_any_way = 0.0;  ///< mean over all directions
    std::size_t most_any_way = 0;

    double smallest_radius = 0.0, largest_radius = 0.0;              ///< [m]
    std::size_t components = 0;                                      ///< pieces that do not overlap each other; 1 for a sound clump
    double sealed_volume = 0.0;                                      ///< [m³], of holes that the outside cannot reach (cells of 1/128 of the size)
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
