// A pellet as a measurement operator sees it: points that share its volume evenly, and its size.
#pragma once

#include <vector>

#include "core/trajectory.hpp"

namespace pelletlab::observables::detail {

struct PelletPoints {
    std::vector<Vec3> points_body;     ///< [m], spread evenly over the inside
    double volume = 0.0;               ///< [m³], of the mass properties: every point stands for volume / points
    double equivalent_diameter = 0.0;  ///< [m], of the sphere of that volume
    double half_height = 0.0;          ///< [m], see half_height() below
    bool has_axis = false;             ///< body z is an axis of symmetry of the inertia: two moments agree within 1 %, the third differs
};

/// About `wanted` low-discrepancy points inside the true surface when it is known (winding number), else inside the union of the spheres.
/// half_height: half the extent along the axis of a pellet that has one, else the mean of the three half extents; from the same surface.
/// Throws Error(bad_input) when the shape has neither a surface nor spheres, or no volume.
PelletPoints sample_pellet(const PelletShape& shape, std::size_t wanted);

/// sample_pellet for every shape of the header.
std::vector<PelletPoints> sample_shapes(const TrajectoryHeader& header, std::size_t wanted);

}  // namespace pelletlab::observables::detail
