// ParaView files (VTK XML): pellets with pose and velocity, the true surface to put there, spheres, moving walls, and a .pvd that ties them to time.
#pragma once

#include <filesystem>

#include "core/trajectory.hpp"

namespace pelletlab::io {

struct ParaviewFiles {
    std::filesystem::path bodies, spheres, walls;  ///< the .pvd files
};

/// Writes <folder>/bodies.pvd, spheres.pvd, walls.pvd and the files that they list; `every` keeps each n-th frame and the last. Bodies are points with
/// a quaternion (w, x, y, z); pellet-<shape>.vtp is the true surface in the body frame, and surface-last.vtp holds all surfaces of the last frame:
/// whole surfaces at every instant would take 100 MB a frame for 1000 pellets of 5700 triangles.
ParaviewFiles write_paraview(const FrameSource& trajectory, const std::filesystem::path& folder, std::size_t every = 1);

}  // namespace pelletlab::io
