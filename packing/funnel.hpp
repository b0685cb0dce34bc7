// A funnel with a shutter, full of loose pellets: how piles and tubes are poured.
#pragma once

#include <vector>

#include "packing/insertion.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::packing {

/// Walls «funnel» and «shutter» of `material` with the outlet at z = outlet_height, and the room above the cone for the case's pellets. A user's own mesh
/// (funnel.mesh_file) takes the place of cone and cylinder; the cylinder for the loose pellets then stands on its upper rim. Throws Error(bad_input) for a
/// mesh whose outlet is not there.
struct Funnel {
    std::vector<solver::WallDefinition> walls;
    InsertionRegion region;
};
Funnel make_funnel(const Case& c, const RigidTemplate& pellet, const std::string& material, double outlet_height);

/// Lets the shutter slide away along +x, beside the outlet, in funnel.shutter_time.
void open_shutter(solver::Simulation& simulation, const FunnelRig& funnel);

/// Pellets with their centre above z = level.
std::size_t pellets_above(const solver::Simulation& simulation, double level);

}  // namespace pelletlab::packing
