// ParaView files (VTK XML): pellets with their true surface, spheres, moving walls, and a .pvd that ties them to time.
#pragma once

#include <filesystem>

#include "core/trajectory.hpp"

namespace pelletlab::io {

struct ParaviewFiles {
    std::filesystem::path bodies, spheres, walls;  ///< the .pvd files
};

/// Writes <folder>/bodies.pvd, spheres.pvd, walls.pvd and the files that they list; `every` keeps each n-th frame and the last.
ParaviewFiles write_paraview(const FrameSource& trajectory, const std::filesystem::path& folder, std::size_t every = 1);

}  // namespace pelletlab::io
