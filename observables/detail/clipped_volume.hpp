// Pellet volume inside rings and slices of a tube, cut exactly: the body within its triangles, the ring's circles and the slice's planes are all exact.
#pragma once

#include <span>
#include <vector>

#include "core/trajectory.hpp"

namespace pelletlab::observables::detail {

/// Integrals of 1, x and y over the part of a polygon inside the circle ρ < radius about the origin; negative for a clockwise polygon. Closed form: triangles
/// (origin, edge) where an edge runs inside the circle, sectors of the circle where it runs outside.
struct PlaneMoments {
    double area = 0.0, x = 0.0, y = 0.0;  ///< [m²], [m³]
};
PlaneMoments polygon_in_circle(std::span<const Vec3> polygon, double radius);  ///< z is not looked at

/// Edges of the rings (radii, ascending, the first may be 0) and of the slices (heights, ascending).
struct TubeCells {
    std::vector<double> radii, heights;

    std::size_t rings() const { return radii.size() - 1; }
    std::size_t slices() const { return heights.size() - 1; }
    std::size_t cells() const { return rings() * slices(); }
    std::size_t index(std::size_t ring, std::size_t slice) const { return slice * rings() + ring; }
    double volume(std::size_t ring, std::size_t slice) const;  ///< [m³]
};

/// (cells) Volume of these bodies in every cell [m³]: over each point (x, y) the solid length in a slice is Σ ± clamp(z) over the surface's triangles above it,
/// + for those that look up, so V = Σ ± ∫∫ clamp(z(x, y)) dx dy over triangle ∩ ring. Exact for closed surfaces but for rounding (about 1e-12 of a pellet).
/// A single sphere without a surface counts as a polyhedron of 2048 faces and the same volume.
std::vector<double> clipped_volumes(const TrajectoryHeader& header, const Frame& frame, std::span<const std::size_t> bodies, const TubeCells& cells);

/// True when every shape has a surface or is one sphere: what clipped_volumes can cut.
bool can_be_clipped(const TrajectoryHeader& header);

}  // namespace pelletlab::observables::detail
