// A closed cylinder that lies: axis y, centre in the origin. Drum, attrition tester and the tube that is filled lying have it in common.
#pragma once

#include <string>
#include <vector>

#include "packing/insertion.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::packing {

struct LyingVessel {
    std::string rig;        ///< its table in the case, for messages
    double diameter = 0.0;  ///< [m], inner
    double length = 0.0;    ///< [m]
    std::uint32_t facets = 96;
    std::string mesh_file;  ///< a user's own vessel
    std::string mesh_unit;
    std::string material;
};

/// The lowest lens of the cylinder that holds the pellets at that packing fraction, one bounding sphere deeper, and deeper still while the lattice of bounding
/// spheres has too few sites: pellets should not fall further than they must.
InsertionRegion lens_region(const RigidTemplate& pellet, std::uint32_t count, double packing_fraction, double diameter, double length);

/// Walls «shell», «front» and «back», or the user's own mesh as «shell». Throws Error(bad_input) for a mesh that does not enclose the cylinder.
std::vector<solver::WallDefinition> lying_walls(const Case& c, const LyingVessel& vessel);

}  // namespace pelletlab::packing
