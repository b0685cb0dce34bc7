// What the shape verbs tell a person: mass properties, distances between clump and body.
#pragma once

#include <string>
#include <vector>

#include "core/clump_template.hpp"
#include "shapegen/make_clump.hpp"

namespace pelletlab::apps {

std::string millimetres(double metres);    ///< «0.0193 mm»
std::string signed_percent(double share);  ///< «−8.73 %»

/// «the mesh», «the union of the spheres», …
std::string name_of(MassSource source);

/// Mass, density and principal inertia, and where they come from.
void print_mass_of(const ClumpTemplate& clump, const std::string& source);

/// Mass properties of mesh, union and sum of the spheres side by side, and which of them the clump carries.
void print_masses(const shapegen::MadeClump& made);

/// Roughness, normals, edges, plane contacts, radii.
void print_surface(const shapegen::MadeClump& made);

/// Time step, contacts and price of the clump in a simulation.
void print_cost(const shapegen::MadeClump& made);

/// How the fit ended, its symmetry, and where the time went.
/// With the wall-clock time of the stages; `reading`: of the mesh and its check [s].
void print_fit(const shapegen::MadeClump& made, double reading);

struct QualityRow {
    std::string name;
    std::size_t spheres = 0;
    FitQuality quality;
};

/// Volume, inertia and distances of each, one under the other.
void print_quality_table(const std::vector<QualityRow>& rows);

/// The moment with the largest error, with its sign.
double worst_inertia_error(const FitQuality& quality);

}  // namespace pelletlab::apps
