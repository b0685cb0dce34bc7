// The drum as a far camera sees it through the front plate: of all pellets only those in front, each with the velocity of the surface that faces the camera.
#pragma once

#include <vector>

#include "core/observables.hpp"
#include "observables/detail/end_view.hpp"

namespace pelletlab::observables::detail {

struct CameraSettings {
    double radius = 0.0;   ///< [m], of the drum
    double front = 0.0;    ///< [m], y of the inside of the front plate; the camera looks along +y
    double depth = 0.0;    ///< [m], what lies further behind the plate is not seen
    double grid = 0.5e-3;  ///< [m], cells of the picture
};

/// Sums over the frames in which something was seen in a cell.
struct CameraSums {
    ViewGrid grid;
    double frames = 0.0;
    std::vector<double> seen, velocity_x, velocity_z, square;  ///< (cells) frames, [m/s], [m/s], [m²/s²]
};

/// In each frame and cell the nearest point of any pellet's surface on the line of sight through the cell's centre (parallel projection, exact on the surface
/// triangles, or on the spheres when there is no surface), if it is no deeper than `depth`, with its velocity v + ω × r. Same bits for any thread count.
CameraSums look(const FrameSource& trajectory, const std::vector<std::size_t>& frames, const CameraSettings& settings);

/// Maps «camera_speed» (of the mean velocity), «camera_vx», «camera_vz», «camera_velocity_fluctuation»; sample_count: frames in which the cell showed a pellet.
std::vector<FieldMap> camera_maps(const CameraSums& sums, const TimeWindow& window);

}  // namespace pelletlab::observables::detail
