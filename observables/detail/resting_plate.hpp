// A flat plate that is lowered onto a bed and tilts as it likes.
#pragma once

#include <vector>

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables::detail {

struct RestingPlate {
    double height = not_known;  ///< [m], world z of the plate's underside in its middle, on the axis x = y = 0
    double tilt = not_known;    ///< [rad], against the horizontal
};

/// The plane z = a + b x + c y above all these pellets whose a is least: where a frictionless plate with its weight in the middle comes to rest. It lies on
/// three pellets (or more) whose points of contact enclose the axis. Exact on true surfaces (their vertices) or spheres. Found by pivots: while a pellet
/// reaches through the plane, its highest point replaces that one of the three which keeps the axis enclosed; each raises the middle. Not known when the
/// pellets do not enclose the axis: then the plate slides off. `radius` [m], of the plate, sets the accuracy: 1e-9 of it.
RestingPlate resting_plate(const TrajectoryHeader& header, const Frame& frame, const std::vector<std::size_t>& bodies, double radius);

}  // namespace pelletlab::observables::detail
