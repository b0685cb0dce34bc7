// Bodies of revolution about the z axis from their profile.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

struct ProfilePoint {
    double r = 0.0, z = 0.0;  ///< [m]
};

/// Number of pieces for a part of the profile of that length, so that they are near-equal to the facets' edge; at least `least`, and not so many that one part
/// takes more than about 4000 triangles.
std::uint32_t piece_count(double length, double edge, std::uint32_t facets, std::uint32_t least = 1);

/// Appends points along a straight line, or along the circle (centre, radius) from one angle to another (0 = outward, π/2 = up), without the first point.
void add_line(std::vector<ProfilePoint>& profile, ProfilePoint to, std::uint32_t pieces);
void add_arc(std::vector<ProfilePoint>& profile, ProfilePoint centre, double radius, double from, double to, std::uint32_t pieces);

/// The body inside the profile, which runs from the bottom to the top with the body on its left; an end off the axis is closed by a flat cap, an end on the
/// axis (r = 0) by a fan. Rings near the axis have fewer vertices.
TriangleMesh revolve(const std::vector<ProfilePoint>& profile, std::uint32_t facets);

/// Scales all radii so that the mesh has that volume.
void scale_radii_to_volume(TriangleMesh& mesh, double volume);

}  // namespace pelletlab::meshes::detail
