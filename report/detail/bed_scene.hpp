// From a stored frame to things to draw: pellets at their poses, walls of glass.
#pragma once

#include "report/pictures.hpp"

namespace pelletlab::report::detail {

/// Throws Error(bad_input) when the frame, the header and the values disagree in their counts, or a wall or pellet shape is missing.
void check_frame(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values);

/// One object a shape; colours from the values by the map over the range.
std::vector<SceneObject> pellets(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const ValueRange& range, bool draw_spheres);

/// Walls in world coordinates, one glass object each.
std::vector<SceneObject> glass_walls(const TrajectoryHeader& header, const Frame& frame);

/// Box of the walls in world coordinates [m]; empty without walls.
Box wall_box(const TrajectoryHeader& header, const Frame& frame);

/// Largest distance of a point of that shape from its centre of mass [m].
double shape_radius(const PelletShape& shape);

/// Smallest range from a round number to a round number that holds the values; with `share` < 1 only that share of them. Lower end 0 when all are ≥ 0.
ValueRange automatic_range(const std::vector<double>& values, double share);

/// Title, colour bar and note on a rendered bed.
void finish_bed_picture(Image& image, const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const ValueRange& range,
                        const PictureSettings& settings);

/// Width that the colour bar takes on the right [pixel], margins included.
double bar_column(const PelletValues& values, const ValueRange& range, std::uint32_t width);

}  // namespace pelletlab::report::detail
