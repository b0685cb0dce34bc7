// Mesh → clump: spheres whose union has the same surface as the body, by least squares on the signed distance.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/symmetry.hpp"

namespace pelletlab::shapegen {

/// What counts as a good fit. Every mode starts from the mean-square fit.
enum class FitMode {
    mean,     ///< least mean square of the distances between the two surfaces
    minimax,  ///< least largest distance
    inside,   ///< no sphere pokes out of the body, proved by the exact distance; the union is as large as it gets. Volume and inertia are what they are
    outside,  ///< the union covers the body, proved piece by piece; it is as small as it gets. Volume and inertia are what they are
    flat      ///< as mean, and the poles on each flat face of the mesh are level with each other: a resting pellet meets a wall evenly
};

enum class SymmetryChoice {
    none,   ///< spheres go where they serve best
    own,    ///< that of the body, as find_symmetry() and symmetry_for() see it, or the largest part of it that the number of spheres allows
    given,  ///< FitSettings::symmetry
};

struct FitSettings {
    FitMode mode = FitMode::mean;
    std::uint32_t sphere_count = 24;  ///< exactly so many come out, 1 … 2000
    double min_radius = 0.0;          ///< [m]; 0: no limit
    double poke_out = 0.0;            ///< [m], how far spheres may reach out of the body in the mode inside
    std::uint32_t most_contacts = 0;  ///< spheres that a plane may touch at once, on flat faces and in any other direction; 0: no limit
    double press = 0.0;               ///< [m], how deep that plane is pressed in; 0: 1/300 of the smallest extent
    SymmetryChoice symmetry_choice = SymmetryChoice::none;
    Symmetry symmetry;          ///< about the body's centre of mass, imposed exactly, when the choice is `given`
    bool match_volume = true;   ///< one common radius offset at the end makes union volume = mesh volume (not in the modes inside and outside)
    bool match_inertia = true;  ///< a shift and a stretch of the centres by at most 0.2 % give the union the mesh's centre and principal inertia
    double effort = 1.0;        ///< scales the number of spheres tried elsewhere: time grows with it, the error falls slowly
    std::uint64_t seed = 1;
};

enum class FitStatus {
    converged,
    stopped_early,     ///< the minimiser still gained when its steps were used up; the fit is sound
    limit_not_met,     ///< most_contacts could not be kept with this minimum radius or symmetry
    criterion_not_met  ///< the accuracy asked for needs more spheres, or costs more, than allowed; this is the best one allowed
};

/// Wall-clock seconds of the stages of a fit.
struct FitTimes {
    double seeds = 0.0, search = 0.0, finish = 0.0;
};

struct FitResult {
    std::vector<Sphere> spheres;  ///< in the frame of the mesh
    std::vector<std::vector<Sphere>>
        fewer;  ///< up to eight spheres without symmetry: the fits of 1, 2, … spheres (mode mean) that the search went through, in the frame of the mesh
    FitStatus status = FitStatus::converged;
    Symmetry symmetry;              ///< that the spheres have by construction, about the body's centre of mass
    double loss = 0.0;              ///< [m²], mean squared distance at the end, average of both directions (up to eight spheres by the exact query)
    double poke_out = 0.0;          ///< [m], no point of the union is farther outside of the body (exact query)
    std::uint32_t iterations = 0;   ///< of the minimiser, all stages
    std::uint32_t relocations = 0;  ///< spheres that found a better place elsewhere
    FitTimes times;
};

/// `body` must be a closed mesh; `search` is its signed distance for the search (the grid, for speed), `exact` the one that proves what the modes promise.
/// Deterministic for a seed, whatever the number of threads. Throws Error(bad_input) for settings that mean nothing, and for a number of spheres that whole
/// orbits of a given symmetry cannot make up.
FitResult fit_spheres(const TriangleMesh& body, const meshes::SignedDistance& search, const meshes::SignedDistance& exact, const FitSettings& settings,
                      const ProgressSink& progress = {});

/// One distance for both.
inline FitResult fit_spheres(const TriangleMesh& body, const meshes::SignedDistance& distance, const FitSettings& settings, const ProgressSink& progress = {}) {
    return fit_spheres(body, distance, distance, settings, progress);
}

}  // namespace pelletlab::shapegen
