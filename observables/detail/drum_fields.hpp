// What is read off the summed end view below its free surface: velocities along the surface, across the depth, in the rigid layer, and maps.
#pragma once

#include <vector>

#include "core/observables.hpp"
#include "observables/detail/free_surface.hpp"

namespace pelletlab::observables::detail {

/// Area of the end view between the free surface and the drum's wall [m²].
double area_below(const FreeSurface& surface, const ViewGrid& grid, const SurfaceSettings& settings);

/// (columns) Mean downhill velocity v_ξ of the material no deeper than `layer` below the surface [m/s]; NaN where there is no surface.
std::vector<double> surface_velocity(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double layer);

/// The same over the middle fifth of the surface.
double middle_surface_velocity(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double layer);

/// (bins) Mean v_ξ over the middle fifth of the surface against the depth below it, in bins of `bin` [m]; NaN where nothing is.
std::vector<double> depth_velocity(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double bin, std::size_t bins);

/// Rotation speed of the layer next to the wall, Σ V (η v_ξ − ξ v_η) / Σ V r², over the material within two pellet diameters of the wall and at least two below
/// the free surface; positive in the drum's own sense [rad/s].
double rigid_layer_rotation(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, const SurfaceSettings& settings);

struct MapSettings {
    double drum_radius = 0.0, drum_length = 0.0;  ///< [m]
    double frames = 0.0;
    double pellet_volume = 0.0;  ///< [m³], mean
    TimeWindow window;
};

/// Maps over the world plane (x, z): «vx», «vz», «speed» (of the mean velocity), «velocity_fluctuation» (root of the variance of both components together),
/// «packing_fraction». Velocities are NaN in cells that saw less than one pellet volume in all frames together.
std::vector<FieldMap> end_view_maps(const CellSums& sums, const ViewGrid& grid, const MapSettings& settings);

}  // namespace pelletlab::observables::detail
