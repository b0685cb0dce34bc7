// What a case asks of its walls beside those that its rig makes of facets: the rig's own surfaces in closed form, and walls of [walls.<name>].
#pragma once

#include <string>
#include <vector>

#include "core/case.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::packing {

/// Gives «shell», «floor», «front» and «back» their exact surfaces where tube.surface or drum.surface asks for them, then appends the walls of [walls.<name>]
/// in the order of their names. Contacts act on exact surfaces; the meshes beside them are what files and pictures show (a plane, which has no end, as a square
/// twice as wide as the rig) and what the domain of the run is taken from.
void add_walls_of_case(const Case& c, std::vector<solver::WallDefinition>& walls);

/// Height above which the walls of [walls.<name>] leave a vertical tube of that radius free, at least 0 [m]. A loose cloud starts there, for a pellet that
/// starts inside a cone never comes out. Planes steeper than 84° are left out: pellets start beside them.
double top_of_extra_walls(const Case& c, double radius);

/// Whether the wall turns with the drum or tester.
bool turns_with_vessel(const Case& c, const std::string& wall);

}  // namespace pelletlab::packing
