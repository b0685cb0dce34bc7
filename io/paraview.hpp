// ParaView files (VTK XML): pellets with pose and velocity, the true surface to put there, spheres, moving walls, and a .pvd that ties them to time.
#pragma once

#include <filesystem>

#include "core/trajectory.hpp"

namespace pelletlab::io {

struct ParaviewFiles {
    std::filesystem::path bodies, spheres, walls;  ///< the .pvd files
    std::filesystem::path surface;                 ///< surface-last.vtp; empty where it was left out
};

/// All true surfaces of a frame in one file take 13 bytes a triangle on disk and 72 in memory: larger beds than this go without.
inline constexpr std::size_t most_surface_triangles = 6'000'000;

/// Writes <folder>/bodies.pvd, spheres.pvd, walls.pvd and the files that they list; `every` keeps each n-th frame and the last. Bodies are points with
/// a quaternion (w, x, y, z); pellet-<shape>.vtp is the true surface in the body frame, and surface-last.vtp holds all surfaces of the last frame where
/// they have no more than `most_surface` triangles: whole surfaces at every instant would take 100 MB a frame for 1000 pellets of 5700 triangles.
ParaviewFiles write_paraview(const FrameSource& trajectory, const std::filesystem::path& folder, std::size_t every = 1,
                             std::size_t most_surface = most_surface_triangles);

}  // namespace pelletlab::io
