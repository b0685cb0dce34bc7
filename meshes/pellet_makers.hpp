// Parametric pellets beyond the plain cylinder: rounded, bevelled and domed tablets, capsules, rings and lobed extrudates.
// All are closed, outward oriented, axis z, centre in the origin, lengths in metres. `facets` is the number of facets of the largest circle (of the whole
// outline for lobed bodies); edges along the axis are near-equal to those of the circle as far as about 4000 side triangles allow. With `volume_exact` all
// radii are scaled so that the mesh has the volume of the true body (heights stay); otherwise vertices lie on the true surface. Every maker throws
// Error(bad_input) for sizes that make no body.
#pragma once

#include <cstdint>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// Cylinder whose two rims are rounded with a quarter circle: 0 ≤ rim_radius ≤ min(diameter, height)/2.
struct RoundedCylinder {
    double diameter = 3.12e-3;
    double height = 2.96e-3;
    double rim_radius = 0.2e-3;
};

/// Cylinder whose rims are cut by a cone: `bevel_width` off the radius and `bevel_height` off the side.
struct BevelledCylinder {
    double diameter = 3.12e-3;
    double height = 2.96e-3;
    double bevel_width = 0.2e-3;
    double bevel_height = 0.2e-3;
};

/// Biconvex tablet: a cylindrical band with spherical caps; whole height = band_height + 2 dome_height, 0 < dome_height ≤ diameter/2, band_height ≥ 0.
struct DomedCylinder {
    double diameter = 3.12e-3;
    double band_height = 2.0e-3;
    double dome_height = 0.48e-3;
};

/// Cylinder with half-spheres on its ends; length over all ≥ diameter (equal: a sphere).
struct Capsule {
    double diameter = 2.0e-3;
    double length = 4.0e-3;
};

/// Hollow cylinder (Raschig ring).
struct HollowCylinder {
    double outer_diameter = 5.0e-3;
    double inner_diameter = 2.5e-3;
    double height = 5.0e-3;
};

/// Extrudate whose cross-section is the union of equal circles around the axis (3: trilobe, 4: quadrulobe), the middle filled. The centres lie `lobe_offset`
/// from the axis; neighbouring circles must overlap: lobe_offset · sin(π/lobes) < lobe_diameter/2.
struct LobedExtrudate {
    std::uint32_t lobes = 3;
    double lobe_diameter = 1.0e-3;
    double lobe_offset = 0.5e-3;
    double height = 3.0e-3;
};

TriangleMesh make_pellet(const RoundedCylinder& body, std::uint32_t facets, bool volume_exact = false);
TriangleMesh make_pellet(const BevelledCylinder& body, std::uint32_t facets, bool volume_exact = false);
TriangleMesh make_pellet(const DomedCylinder& body, std::uint32_t facets, bool volume_exact = false);
TriangleMesh make_pellet(const Capsule& body, std::uint32_t facets, bool volume_exact = false);
TriangleMesh make_pellet(const HollowCylinder& body, std::uint32_t facets, bool volume_exact = false);
TriangleMesh make_pellet(const LobedExtrudate& body, std::uint32_t facets, bool volume_exact = false);

/// Closed non-convex body as a scanner would give it: a lump with a head, two ears and a hollow back, roughened at two scales; star-shaped about the origin.
/// `subdivisions` as in make_sphere (5: 20480 triangles). Deterministic for a seed.
struct ScanLike {
    double size = 4.0e-3;      ///< about the longest extent
    double roughness = 0.015;  ///< rms height of the small bumps / size
    std::uint64_t seed = 1;
};
TriangleMesh make_scan_like(const ScanLike& body, std::uint32_t subdivisions);

/// Volume of the true body [m³], in closed form.
double exact_volume(const RoundedCylinder& body);
double exact_volume(const BevelledCylinder& body);
double exact_volume(const DomedCylinder& body);
double exact_volume(const Capsule& body);
double exact_volume(const HollowCylinder& body);
double exact_volume(const LobedExtrudate& body);

/// The mesh stretched along its axes, every factor positive: an oval cylinder from a round one, a family of sizes from one pellet.
TriangleMesh stretched(TriangleMesh mesh, const Vec3& factors);

}  // namespace pelletlab::meshes
