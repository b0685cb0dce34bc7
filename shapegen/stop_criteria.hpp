// «As few spheres as it takes», and «as good as it gets for that price»: the number of spheres from the accuracy or the DEM cost that is wanted.
#pragma once

#include "core/clump_template.hpp"
#include "core/progress.hpp"
#include "shapegen/dem_cost.hpp"
#include "shapegen/fit.hpp"

namespace pelletlab::shapegen {

/// Each criterion that is above 0 must be met.
struct StopCriteria {
    double volume_error = 0.0;          ///< |V_union / V_body − 1|. The modes mean, minimax and flat match the volume anyway, with any number of spheres
    double symmetric_difference = 0.0;  ///< missing + outside volume, relative to the body's
    double inertia_error = 0.0;         ///< largest |error| of the principal moments at equal density
    double mean = 0.0;                  ///< [m], mean distance of both directions
    double rms = 0.0;                   ///< [m]
    double max = 0.0;                   ///< [m]
    double edge_radius = 0.0;           ///< [m], mean rounding of the sharp convex edges
    std::uint32_t most_spheres = 2000;  ///< beyond it the search gives up

    bool any() const { return volume_error != 0 || symmetric_difference != 0 || inertia_error != 0 || mean != 0 || rms != 0 || max != 0 || edge_radius != 0; }
};

struct StoppedFit {
    FitResult fit;  ///< with the status criterion_not_met when not even most_spheres meet the criteria, or one sphere costs too much already
    FitQuality quality;
    std::uint32_t attempts = 0;  ///< fits made
};

/// Doubles the number of spheres until the criteria are met, then halves the interval: the fewest spheres, up to the scatter of a fit (about 1 % of the
/// distances). settings.sphere_count is not used; numbers that whole orbits of a given symmetry cannot
/// make up are rounded up. Throws Error(usage) when no criterion is given. `search` and `exact` as in fit_spheres.
StoppedFit fit_to_criteria(const TriangleMesh& body, const meshes::SignedDistance& search, const meshes::SignedDistance& exact, const FitSettings& settings,
                           const StopCriteria& criteria, const ProgressSink& progress = {});

/// The most accurate clump (rms) whose cost (dem_cost, with the body's mass at `density`) is at most `most_cost` × that of the study's Shape 2 of the same
/// density: the most spheres that the cost allows, as they come and with 6 or 3 plane contacts at most, which lengthens the time step. A limit of contacts or a
/// symmetry that is asked for stays as it is. settings.sphere_count is not used.
StoppedFit fit_within_cost(const TriangleMesh& body, const meshes::SignedDistance& search, const meshes::SignedDistance& exact, const FitSettings& settings,
                           double density, double most_cost, const DemCostSettings& cost, const ProgressSink& progress = {});

}  // namespace pelletlab::shapegen
