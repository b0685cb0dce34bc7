// Parametric meshes: simple bodies and the walls of the rigs. All coordinates in metres. Pellets of more shapes: pellet_makers.hpp.
// Every maker throws Error(bad_input) for a size that is not positive and finite, or for fewer than 3 facets.
#pragma once

#include <cstdint>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// Closed cylinder, axis z, centre in the origin. `facets` of the circle; vertices lie on the true circle scaled so that the
/// polygon's area equals the circle's (volume exact) when `volume_exact`, else on the circle itself. Faces are well shaped (rows and rings of near-equal
/// edges) as far as about 4000 side and 800 end triangles allow; beyond that rows get higher and rings wider, so a mesh of 256 facets stays near 6000 faces.
TriangleMesh make_cylinder(double diameter, double height, std::uint32_t facets, bool volume_exact = false);

/// Shell without ends whose facets touch a circle of the inner diameter from outside (inradius = diameter/2); axis z from z = bottom to top,
/// normals pointing inward (towards the pellets).
TriangleMesh make_tube_shell(double diameter, double bottom, double top, std::uint32_t facets);

/// Flat round plate of that radius (a polygon circumscribed about it) in the plane z = level, normal +z or −z. With radius = diameter/2 and the
/// same facets its rim has bit for bit the vertices of make_tube_shell, so shell and plate weld into one closed vessel.
TriangleMesh make_disc(double radius, double level, bool facing_up, std::uint32_t facets);

/// Drum parts about axis y, centre in the origin: shell (normals inward) and the two end plates at y = ±length/2 (normals inward:
/// the plate at y = −length/2 faces +y). Rims match as those of tube shell and disc do.
TriangleMesh make_drum_shell(double diameter, double length, std::uint32_t facets);
TriangleMesh make_drum_end(double diameter, double y, bool facing_positive_y, std::uint32_t facets);

/// Funnel about the z axis, open at both ends, normals inward: a cone from the outlet at z = bottom up to top_diameter, and above it a cylinder up to z = top.
/// half_angle [rad] between the cone's wall and the vertical. Inner diameters, as make_tube_shell. Throws when `top` lies below the cone's upper rim.
TriangleMesh make_funnel(double outlet_diameter, double top_diameter, double half_angle, double bottom, double top, std::uint32_t facets);
/// z at which the cone of that funnel ends, above its outlet [m].
double funnel_cone_height(double outlet_diameter, double top_diameter, double half_angle);

/// Radial plate inside a drum (axis y, centre in the origin): closed box of that length along y, from the shell's radius `height` inward, its middle plane
/// through the axis at `angle` [rad]: 0 points down, growing as a turn about +y carries it (down, −x, up, +x).
TriangleMesh make_baffle(double drum_diameter, double length, double height, double thickness, double angle);

/// The second mesh behind the first, nothing welded.
TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other);

/// Axis-aligned closed box, outward normals; geodesic sphere from a subdivided icosahedron (20 · 4^subdivisions faces, vertices on the sphere).
TriangleMesh make_box(const Vec3& lower, const Vec3& upper);
TriangleMesh make_sphere(double diameter, std::uint32_t subdivisions);

}  // namespace pelletlab::meshes
