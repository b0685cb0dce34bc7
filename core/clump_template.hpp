// A clump as shapegen makes it and files keep it: spheres, mass properties, how well it fits and where it comes from.
#pragma once

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
};

/// How well the union of spheres reproduces the target body.
struct FitQuality {
    double volume_error = 0.0;          ///< V_union / V_target − 1
    Vec3 inertia_error = Vec3::Zero();  ///< I_union / I_target − 1 at equal density, smallest moment first
    double centre_offset = 0.0;         ///< [m], between the centres of mass
    double symmetric_difference = 0.0;  ///< (missing + outside volume) / V_target
    DistanceFigures target_to_union;    ///< from points of the target surface to the union's surface
    DistanceFigures union_to_target;    ///< from points of the union's outer surface to the target surface
    DistanceFigures both;               ///< mean of the two directions; max of the worse one
    double distance_error_bound = 0.0;  ///< [m], largest error of the distance query used for these figures
};

struct ClumpTemplate {
    RigidTemplate rigid;
    MassSource mass_source = MassSource::target_mesh;
    FitQuality quality;
    std::string mesh_file;  ///< as given by the user; empty if there was none
    std::string mesh_unit;  ///< «mm»
    std::string mesh_hash;  ///< SHA-256 of the file
    Provenance provenance;
};

}  // namespace pelletlab
