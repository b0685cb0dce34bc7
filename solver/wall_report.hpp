// What a wall mesh looks like before a run: counts that a user should see, with the places of what is odd.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::solver {

struct WallReport {
    std::size_t faces = 0;             ///< kept
    std::size_t patches = 0;           ///< smooth surfaces between sharp joins
    std::size_t degenerate_faces = 0;  ///< without area: dropped
    std::size_t double_faces = 0;      ///< same three vertices: dropped
    std::size_t border_edges = 0;      ///< with one face: rims, gaps, T-junctions
    std::size_t crowded_edges = 0;     ///< with three faces or more
    std::size_t turned_joins = 0;      ///< neighbours whose windings disagree (harmless here: both sides act)
    std::size_t slivers = 0;           ///< height below 1e-4 of the longest side
    std::size_t t_junctions = 0;       ///< vertices that lie inside a border edge of another face
    std::vector<Vec3> odd_places;      ///< [m], up to 16: crowded edges, T-junctions, slivers
};

/// The report for a mesh with this feature angle [rad]; the same that Simulation::wall_reports() gives.
WallReport inspect_wall(const TriangleMesh& mesh, double feature_angle = 0.5235987755982988);

}  // namespace pelletlab::solver
