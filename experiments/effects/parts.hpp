// The pieces of the library, one file each; put together in effects.cpp.
#pragma once

#include <vector>

#include "experiments/effects/effects.hpp"

namespace pelletlab::experiments::effects {

std::vector<Effect> operating_effects();  ///< purely another value of a case key: one table

Effect end_plate_friction();
Effect axis_tilt();
Effect weld_bead();
Effect velocity_dependent_restitution();
std::vector<Effect> cohesion_effects();
Effect vibration();
Effect edge_rounding();

Effect camera_layer();
Effect window_average();
std::vector<Effect> camera_geometry_effects();

/// The contact row of a wall: «pellet-<wall>», else that of the material.
ContactParameters contact_with_wall(const Case& c, const std::string& wall, const std::string& material);

}  // namespace pelletlab::experiments::effects
