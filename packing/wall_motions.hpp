// Walls of a running simulation that begin to move.
#pragma once

#include <functional>
#include <string>

#include "solver/simulation.hpp"

namespace pelletlab::packing {

/// Changes the motion of every wall whose name is chosen; what the change leaves alone (a vibration) goes on.
void change_motions(solver::Simulation& simulation, const std::function<bool(const std::string& wall)>& chosen,
                    const std::function<void(solver::WallMotion&)>& change);

}  // namespace pelletlab::packing
