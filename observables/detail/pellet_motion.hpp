// How fast the pellets of a drum are, one by one: speeds of their centres, and their trembling about the local mean.
#pragma once

#include <vector>

#include "core/observables.hpp"
#include "observables/detail/drum_analysis.hpp"

namespace pelletlab::observables::detail {

/// Sums of one group of frames.
struct MotionSums {
    std::vector<double> speeds;         ///< [m/s], of every pellet in every frame
    std::vector<double> count, square;  ///< (cells) pellets, [m²/s²]
    std::vector<Vec3> velocity;         ///< (cells) [m/s]
};

/// Cells of one pellet diameter over the end view.
struct PelletMotion {
    ViewGrid grid;
    std::vector<MotionSums> groups;
    MotionSums whole() const;
};

PelletMotion pellet_motion(const FrameSource& trajectory, const std::vector<std::vector<std::size_t>>& groups, double radius, double diameter,
                           const ViewFilter& filter);

/// T = Σ_cells (Σ v² − |Σ v|²/n) / (3 Σ_cells (n − 1)) [m²/s²] over the cells that `wanted` accepts: a third of the mean square of the velocity about the mean
/// of its cell, without the bias of that mean. NaN when no cell holds two pellets.
double granular_temperature(const MotionSums& sums, const std::vector<bool>& wanted);

/// (cells) the same for each cell with at least five pellets, else NaN.
std::vector<double> temperature_of_cells(const MotionSums& sums);

/// Share of the values in each of `bins` bins of that width from 0, per width; what is larger counts in the last one.
std::vector<double> density(const std::vector<double>& values, double width, std::size_t bins);

}  // namespace pelletlab::observables::detail
