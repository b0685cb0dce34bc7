// The top surface of a pile, as a cone, as silhouettes and as a profile. Lengths [m]; heights count from the plate, places from the pouring axis.
#pragma once

#include <array>
#include <vector>

#include "observables/detail/top_surface.hpp"

namespace pelletlab::observables::detail {

inline constexpr std::size_t azimuth_sectors = 16;
inline constexpr double flank_top = 0.8, flank_foot = 0.2;  ///< shares of the smoothed height between which a flank is fitted

/// Highest mean height over a square of that side anywhere on the grid; lines that meet no pellet count as 0.
double smoothed_height(const HeightGrid& grid, double side);

/// z = apex − slope · distance from (x, y).
struct Cone {
    double x = 0.0, y = 0.0, apex = 0.0, slope = 0.0;
    double inner = 0.0, outer = 0.0;  ///< distances between which it was fitted
    bool found = false;
    std::array<double, azimuth_sectors> sector_angle{};  ///< [rad], lines through the same heights, sector by sector about (x, y); NaN with too few
    std::array<double, azimuth_sectors> sector_apex{};
};

/// Least squares over the lines between the distances where the ring means (rings of `ring` about the cone's own axis) fall below flank_top and flank_foot of
/// `height`; axis, apex and slope are free (Gauss–Newton), and rings and fit are repeated until the axis stays.
Cone fit_cone(const HeightGrid& grid, double height, double ring);

/// Mean height over rings of that width about (x, y), and per sector; 0 where no pellet is, NaN beyond the grid.
struct RingMeans {
    std::vector<double> distance, mean;
    std::vector<std::array<double, azimuth_sectors>> sector;
};
RingMeans ring_means(const HeightGrid& grid, double x, double y, double ring);

/// Distance at which the means first fall below `height`, linear between rings; NaN when they do not.
double first_below(const std::vector<double>& distance, const std::vector<double>& mean, double height);

/// Outline that a far camera sees: highest point over each line of sight. along_x: over x, looking along y.
struct Silhouette {
    std::vector<double> place, height;
};
Silhouette silhouette(const HeightGrid& grid, bool along_x);

/// Angles [rad] of the outline's two flanks, towards negative and positive places: lines through it between the places where, from its highest point
/// outward, it first falls below flank_top and flank_foot of that height. NaN without a flank of at least three places.
std::array<double, 2> flank_angles(const Silhouette& outline);

}  // namespace pelletlab::observables::detail
