// The free surface of a bed in a drum: where the time-averaged occupancy of the end view falls to one half.
#pragma once

#include <vector>

#include "observables/detail/end_view.hpp"

namespace pelletlab::observables::detail {

/// How the occupancy grid is smoothed and cut; lengths [m].
struct SurfaceSettings {
    double drum_radius = 0.0;
    double drum_length = 0.0;
    double pellet_diameter = 0.0;  ///< equivalent one
};

/// Local packing fraction of the end view: pellet volume in a box of one pellet diameter along ξ and half of one along η, per volume of that box inside the
/// drum. NaN in cells outside the drum.
std::vector<double> packing_field(const ViewGrid& grid, const std::vector<double>& volume, double frames, const SurfaceSettings& settings);

/// Packing fraction of the bed's inside: the volume-weighted median of the packing fraction over cells of one pellet diameter squared, that is, half of all
/// pellet volume lies in cells that are packed more densely.
double bulk_packing_fraction(const ViewGrid& grid, const std::vector<double>& volume, double frames, const SurfaceSettings& settings);

/// Free surface as one η for every ξ column; NaN in columns where the bed is thinner than half a pellet diameter or there is none.
struct FreeSurface {
    std::vector<double> xi, eta;    ///< [m]
    double begin = 0.0, end = 0.0;  ///< [m], ξ where the surface begins and ends: outer edges of the outermost columns that have one
};

/// Comes from outside (largest η) towards the bed and stops where the packing fraction first reaches `threshold`, linear between rows.
FreeSurface free_surface(const ViewGrid& grid, const std::vector<double>& packing, double threshold, const SurfaceSettings& settings);

/// World z of the surface at these world x, by linear interpolation along the surface; the upper one where it overhangs, NaN beyond its ends.
std::vector<double> surface_height(const FreeSurface& surface, const ChordFrame& chord, const std::vector<double>& x);

/// Figures of a surface.
struct SurfaceFigures {
    double upper_angle = 0.0, lower_angle = 0.0, whole_angle = 0.0;  ///< [rad], positive when the surface falls along +ξ
    double highest = 0.0;                                            ///< [m], world z of its highest point
};
SurfaceFigures surface_figures(const FreeSurface& surface, const ChordFrame& chord);

/// Shares of the surface's length, counted from its uphill end, that the lines are fitted to. The last tenth at either wall and the bend in the middle are
/// left out of the two halves; the whole angle leaves out the walls only.
inline constexpr double upper_begin = 0.1, upper_end = 0.4, lower_begin = 0.6, lower_end = 0.9;

}  // namespace pelletlab::observables::detail
