// What a clump costs in a DEM run, before any run: the stable time step from its stiffest contact, and the contacts to work through.
#pragma once

#include <cstddef>
#include <span>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen {

/// Material and depth at which contacts are counted; ratios of costs hardly depend on them.
struct DemCostSettings {
    double shear_modulus = 2e6;  ///< [Pa]
    double poisson_ratio = 0.25;
    double press = 0.0;           ///< [m], how deep a plane is pressed in; 0: 1/300 of (6 V / π)^⅓, V the body's volume
    double neighbours = 4.0;      ///< touching neighbours of a pellet in a bed: each pair's contacts are worked through once
    double work_of_pellet = 1.7;  ///< of one pellet in one step without its contacts, in works of one contact; measured on this solver (docs/quality.md)
    double work_of_sphere = 0.0;  ///< of each of its spheres: none here, the solver looks only at those that face a neighbour; above 0 for a program that
                                  ///< treats every sphere as a particle
};

struct DemCost {
    double time_step = 0.0;         ///< [s], 2 / ω_max: stability limit of velocity Verlet with the clump pressed between two planes in its stiffest direction
    double contacts_mean = 0.0;     ///< spheres that touch a pressed-in plane at once, mean over all directions
    std::size_t contacts_most = 0;  ///< the most in any direction looked at
    double work = 0.0;              ///< of one pellet and step, in works of one contact: work_of_pellet + N · work_of_sphere + ½ neighbours · contacts_mean
    double cost = 0.0;              ///< work / time_step [1/s]: work for a second of simulated time
};

/// Hertz–Mindlin contacts k_n = 2 E* √(r δ), k_t/k_n = 2 (1 − ν)/(2 − ν), as the solver takes them, of every sphere that reaches the plane;
/// ω² is the largest eigenvalue of M⁻¹K, K = Σ k JᵀJ over normal and tangential directions of all contacts, with the lever arms about the centre of
/// mass, over 400 directions and the six ways along the principal axes. `spheres_body` and `mass` in the body frame (RigidTemplate).
DemCost dem_cost(std::span<const Sphere> spheres_body, const MassProperties& mass, const DemCostSettings& settings = {});

/// Cost of the study's hand-made Shape 2 (24 spheres) with the mass of its cylinder at that density: the usual unit.
DemCost dem_cost_of_shape_2(double density, const DemCostSettings& settings = {});

}  // namespace pelletlab::shapegen
