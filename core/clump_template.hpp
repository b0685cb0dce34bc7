// A clump as shapegen makes it and files keep it: spheres, mass properties, how well it fits and where it comes from.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/provenance.hpp"
#include "core/rigid_template.hpp"

namespace pelletlab {

/// Which body the mass properties are taken from.
enum class MassSource { target_mesh, union_of_spheres, density_matched_union };

/// Distance figures of one direction or of both together [m].
struct DistanceFigures {
    double mean = 0.0;  ///< of |distance|
    double rms = 0.0;
    double max = 0.0;
    double p99 = 0.0;
    double signed_mean = 0.0;  ///< one direction: > 0 where the points lie outside of the other body; both: > 0 where the union is larger than the body
};

/// What the surface of a clump feels like to its neighbours; definitions in docs/quality.md. NaN: not measured, or the body has no such place.
struct SurfaceFigures {
    static constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

    double flat_sq = not_measured, flat_sz = not_measured;      ///< [m], roughness of all flat patches together, each about its own mean (sz: the worst)
    double curved_sq = not_measured, curved_sz = not_measured;  ///< [m], of all others

    double normal_mean = not_measured;  ///< [rad], angle between the union's normal and the body's at the nearest point, over the exposed outer area
    double normal_rms = not_measured;   ///< [rad]
    double normal_p95 = not_measured;   ///< [rad]

    /// Sharp convex edges: way from the edge along its bisector to the union, and the radius of a rounded edge with the same gap,
    /// gap / (1/sin(θ/2) − 1) at the inner angle θ.
    double edge_gap_mean = not_measured, edge_gap_max = not_measured;        ///< [m]
    double edge_radius_mean = not_measured, edge_radius_max = not_measured;  ///< [m]

    /// Support function: how much farther a plane rests from the centre on the union than on the body, over all directions.
    double support_mean = not_measured, support_rms = not_measured, support_max = not_measured;  ///< [m], max of the absolute value

    /// Spheres that touch a plane pressed in by `press`.
    double press = not_measured;             ///< [m]
    double contacts_on_flat = not_measured;  ///< mean over the flat faces
    std::size_t most_on_flat = 0;            ///< on one of them
    double contacts_any_way = not_measured;  ///< mean over all directions
    std::size_t most_any_way = 0;

    double smallest_radius = not_measured, largest_radius = not_measured;  ///< [m]
    std::size_t components = 0;                                            ///< pieces that do not overlap each other; 1 for a sound clump, 0: not counted
    double sealed_volume = not_measured;                                   ///< [m³], of holes that the outside cannot reach (cells of 1/128 of the size)
};

/// How well the union of spheres reproduces the target body.
struct FitQuality {
    double volume_error = 0.0;          ///< V_union / V_target − 1
    Vec3 inertia_error = Vec3::Zero();  ///< I_union / I_target − 1 at equal density, smallest moment first
    double centre_offset = 0.0;         ///< [m], between the centres of mass
    double symmetric_difference = 0.0;  ///< (missing + outside volume) / V_target
    double missing = 0.0;               ///< volume of the target that no sphere covers / V_target
    double outside = 0.0;               ///< volume of the union outside of the target / V_target
    DistanceFigures target_to_union;    ///< from points of the target surface to the union's surface
    DistanceFigures union_to_target;    ///< from points of the union's outer surface to the target surface
    DistanceFigures both;               ///< mean of the two directions; max of the worse one
    double distance_error_bound = 0.0;  ///< [m], largest error of the distance query used for these figures
    SurfaceFigures surface;
};

/// The same density on three bodies: the target mesh, the union of the spheres, and their plain sum, which counts overlaps as often as they occur.
/// A volume of 0 stands for «not known».
struct MassComparison {
    MassProperties mesh, of_union, sum;
};

struct ClumpTemplate {
    RigidTemplate rigid;
    MassSource mass_source = MassSource::target_mesh;
    FitQuality quality;
    MassComparison masses;  ///< beside rigid.mass_properties, which is one of them (density_matched_union: of_union at another density)
    std::string mesh_file;  ///< as given by the user; empty if there was none
    std::string mesh_unit;  ///< «mm»
    std::string mesh_hash;  ///< SHA-256 of the file
    Provenance provenance;
};

}  // namespace pelletlab
