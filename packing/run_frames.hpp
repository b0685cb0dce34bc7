// The bridge from a running simulation to stored frames: what every rig needs.
#pragma once

#include <functional>

#include "core/case.hpp"
#include "core/clump_template.hpp"
#include "core/progress.hpp"
#include "core/trajectory.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::packing {

using FrameSink = std::function<void(const Frame&)>;

/// What a rig is given besides its case.
struct RunInputs {
    ClumpTemplate clump;
    TriangleMesh pellet_surface_body;  ///< true surface in the body frame, for pictures and exact clipping; may be empty
    std::string resolved_case;
    Provenance provenance;
};

/// Simulation of the case's pellets (density from the case's material) between these walls.
solver::SimulationDefinition define_simulation(const Case& c, const RunInputs& inputs, std::vector<solver::WallDefinition> walls);

/// Wall of the case's material with the contact row «pellet-<name>», else «pellet-<material>».
solver::WallDefinition define_wall(const Case& c, std::string name, TriangleMesh mesh, const std::string& material);

/// Pellets of `in_all` that have not been released yet have a NaN position and velocity.
Frame capture_frame(const solver::Simulation& simulation, std::size_t in_all = 0);
TrajectoryHeader trajectory_header(const Case& c, const RunInputs& inputs, const solver::Simulation& simulation);

}  // namespace pelletlab::packing
