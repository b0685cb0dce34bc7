// Building blocks of the makers: rings of points about the z axis, and the bands of triangles between them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Unit vectors at the angles 2π(k + phase)/count. The same arguments give the same bits, so parts that share a rim weld.
std::vector<Vec3> unit_circle(std::uint32_t count, double phase = 0.0);

/// Radius of the polygon's corners so that its edges touch a circle of radius 1 from outside, 1/cos(π/n), and so that its area equals the
/// circle's, sqrt(2π/n / sin(2π/n)).
double circumscribed_factor(std::uint32_t facets);
double equal_area_factor(std::uint32_t facets);

/// Indices of the consecutive vertices of one ring, counter-clockwise about +z.
struct Ring {
    std::uint32_t first = 0, count = 0;
    double phase = 0.0;  ///< of its first vertex, in steps of the ring
    std::uint32_t at(std::uint32_t k) const { return first + k % count; }
};

/// Appends a ring of points (radius · circle, z).
Ring add_ring(TriangleMesh& mesh, std::uint32_t count, double radius, double z, double phase = 0.0);

/// Triangles between two rings of any counts, taking at each step the shorter of the two possible angles. Seen with +z up and the eye outside the
/// axis, normals point away from the axis when `upper` lies above `lower`; for rings in one plane they point to +z when `upper` is the inner one.
void add_band(TriangleMesh& mesh, const Ring& lower, const Ring& upper);

/// Closes a ring with a flat cap at its own height: concentric rings of near-equal edges down to a centre vertex, normal +z or −z. Edges grow inward just
/// enough to keep the cap below about `max_faces` triangles.
void add_flat_cap(TriangleMesh& mesh, const Ring& rim, double radius, double z, bool facing_up, std::size_t max_faces);

/// Reverses all triangles from that face on.
void flip_faces(TriangleMesh& mesh, std::size_t from = 0);

}  // namespace pelletlab::meshes::detail
