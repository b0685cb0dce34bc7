// The pictures that the verbs write: a bed in its tube, a drum seen through its end plate, a velocity map, a clump beside its mesh.
#pragma once

#include "report/render.hpp"

namespace pelletlab::report {

struct PictureSettings {
    std::uint32_t width = 1200;  ///< [pixel]
    bool draw_spheres = false;   ///< the clump's spheres instead of the true surface
};

/// `frame` of the trajectory: tube seen from the side, glass shell; pellets coloured by height.
Image picture_of_tube(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings);
/// Drum seen along +y through the front plate (not drawn), pellets coloured by speed, with a colour bar.
Image picture_of_drum(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings);
/// Colour map of speed with arrows, colour bar with numbers and unit.
Image picture_of_map(const Observables& observables, const std::string& map_name, const PictureSettings& settings);
/// Left the body, right the clump coloured by its distance to the body's surface; colour bar in mm.
Image picture_of_clump(const TriangleMesh& body, std::span<const Sphere> spheres_mesh, std::span<const double> union_vertex_distance,
                       const PictureSettings& settings);

}  // namespace pelletlab::report
