// The pictures that the verbs write: a bed in its tube, a drum seen through its end plate, a velocity map, a clump beside its mesh.
// All throw Error(bad_input) for a width below 200 pixels, and for input that does not fit together.
#pragma once

#include <functional>
#include <optional>

#include "report/colour_map.hpp"
#include "report/render.hpp"

namespace pelletlab::report {

struct PictureSettings {
    std::uint32_t width = 1200;        ///< [pixel]
    bool draw_spheres = false;         ///< the clump's spheres instead of the true surface
    std::uint32_t samples = 16;        ///< rays a pixel
    std::optional<std::string> title;  ///< upper left; nothing: made from the case's name, the number of pellets and the time
    std::optional<ValueRange> range;   ///< what the ends of the colour bar stand for [SI]; nothing: from the data
    std::optional<double> view_top;    ///< tube: [m], height up to which the bed is shown; nothing: from the frame
    double azimuth = 0.0;              ///< tube, pile: [rad], camera turned about the axis
    double circle_diameter = 0.0;      ///< map: [m], drum drawn round the origin; 0: none
};

/// A number a pellet to colour it by.
struct PelletValues {
    std::vector<double> value;  ///< (bodies) in the unit of the label
    std::string label;          ///< «coordination number»
    ColourMap map = ColourMap::sequential;
};

/// `frame` of the trajectory: tube seen from the side, glass shell; pellets coloured by height of their centre above the floor.
Image picture_of_tube(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings);
/// The same, coloured by other numbers; settings.range is in their unit.
Image picture_of_tube(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const PictureSettings& settings);

/// Drum (axis y) seen along +y through the front plate (not drawn), pellets coloured by speed, with a colour bar.
Image picture_of_drum(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings);
Image picture_of_drum(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const PictureSettings& settings);

/// Pile on the plate z = 0 seen from a little above, without its walls; pellets coloured by height. Nearly all that lie on the plate are in the picture.
Image picture_of_pile(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings);

/// Colour map of a field with axes in mm and a colour bar; arrows where the observables also hold the maps vx and vz on the same grid.
Image picture_of_map(const Observables& observables, const std::string& map_name, const PictureSettings& settings);

/// Surface of every sphere as a fine mesh, one after the other (parts inside other spheres included): what picture_of_clump colours.
TriangleMesh sphere_surfaces(std::span<const Sphere> spheres);
/// Left the body, right the clump coloured by its signed distance to the body's surface; colour bar in mm.
/// `union_vertex_distance` [m]: one number a vertex of sphere_surfaces(spheres_mesh).
Image picture_of_clump(const TriangleMesh& body, std::span<const Sphere> spheres_mesh, std::span<const double> union_vertex_distance,
                       const PictureSettings& settings);
/// The same, asking for the distances [m] itself: pass `[&](std::span<const Vec3> p) { return exact->values(p); }`.
Image picture_of_clump(const TriangleMesh& body, std::span<const Sphere> spheres_mesh,
                       const std::function<std::vector<double>(std::span<const Vec3>)>& signed_distance, const PictureSettings& settings);

}  // namespace pelletlab::report
