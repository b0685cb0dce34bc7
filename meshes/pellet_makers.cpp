// Pellets of revolution. Lobed extrudates: lobed_maker.cpp.
#include "meshes/pellet_makers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "meshes/detail/require.hpp"
#include "meshes/detail/revolve.hpp"
#include "meshes/detail/rings.hpp"

namespace pelletlab::meshes {
namespace {

constexpr double pi = std::numbers::pi;
using Profile = std::vector<detail::ProfilePoint>;

void require_shape(bool holds, const char* problem, const char* remedy) {
    if (!holds) throw bad_input(problem, remedy);
}

double edge_of(double diameter, std::uint32_t facets) {
    return pi * diameter / facets;
}

TriangleMesh finished(const Profile& profile, std::uint32_t facets, bool volume_exact, double volume) {
    TriangleMesh mesh = detail::revolve(profile, facets);
    if (volume_exact) detail::scale_radii_to_volume(mesh, volume);
    return mesh;
}

void require_valid(const RoundedCylinder& b) {
    detail::require_positive(b.diameter, "diameter");
    detail::require_positive(b.height, "height");
    require_shape(b.rim_radius >= 0.0 && b.rim_radius <= 0.5 * std::min(b.diameter, b.height),
                  "the rim radius of a cylinder lies outside 0 … half its diameter and height", "choose a smaller rim radius");
}

void require_valid(const BevelledCylinder& b) {
    detail::require_positive(b.diameter, "diameter");
    detail::require_positive(b.height, "height");
    detail::require_positive(b.bevel_width, "bevel width");
    detail::require_positive(b.bevel_height, "bevel height");
    require_shape(b.bevel_width < 0.5 * b.diameter && b.bevel_height <= 0.5 * b.height, "the bevels of a cylinder take more than there is",
                  "choose smaller bevels");
}

void require_valid(const DomedCylinder& b) {
    detail::require_positive(b.diameter, "diameter");
    detail::require_positive(b.dome_height, "dome height");
    require_shape(b.band_height >= 0.0 && std::isfinite(b.band_height), "the band height of a tablet is negative", "give 0 or more");
    require_shape(b.dome_height <= 0.5 * b.diameter * (1.0 + 1e-12), "the domes of a tablet are higher than half-spheres", "choose at most half the diameter");
}

void require_valid(const Capsule& b) {
    detail::require_positive(b.diameter, "diameter");
    require_shape(b.length >= b.diameter && std::isfinite(b.length), "a capsule is shorter than its diameter", "the length counts over all");
}

void require_valid(const HollowCylinder& b) {
    detail::require_positive(b.outer_diameter, "outer diameter");
    detail::require_positive(b.inner_diameter, "inner diameter");
    detail::require_positive(b.height, "height");
    require_shape(b.inner_diameter < b.outer_diameter, "the bore of a ring is not narrower than the ring", "choose inner_diameter < outer_diameter");
}

}  // namespace

double exact_volume(const RoundedCylinder& b) {
    require_valid(b);
    const double r = 0.5 * b.diameter, q = b.rim_radius, flat = r - q;
    return pi * r * r * (b.height - 2.0 * q) + 2.0 * pi * (flat * flat * q + 0.5 * pi * flat * q * q + 2.0 / 3.0 * q * q * q);
}

double exact_volume(const BevelledCylinder& b) {
    require_valid(b);
    const double r = 0.5 * b.diameter, end = r - b.bevel_width;
    return pi * r * r * (b.height - 2.0 * b.bevel_height) + 2.0 / 3.0 * pi * b.bevel_height * (r * r + r * end + end * end);
}

double exact_volume(const DomedCylinder& b) {
    require_valid(b);
    const double r = 0.5 * b.diameter, h = b.dome_height;
    return pi * r * r * b.band_height + pi / 3.0 * h * (3.0 * r * r + h * h);
}

double exact_volume(const Capsule& b) {
    require_valid(b);
    const double r = 0.5 * b.diameter;
    return pi * r * r * (b.length - b.diameter) + 4.0 / 3.0 * pi * r * r * r;
}

double exact_volume(const HollowCylinder& b) {
    require_valid(b);
    return 0.25 * pi * (b.outer_diameter * b.outer_diameter - b.inner_diameter * b.inner_diameter) * b.height;
}

TriangleMesh make_pellet(const RoundedCylinder& b, std::uint32_t facets, bool volume_exact) {
    require_valid(b);
    detail::require_facets(facets);
    const double r = 0.5 * b.diameter, q = b.rim_radius, edge = edge_of(b.diameter, facets), side = b.height - 2.0 * q;
    const double z = 0.5 * b.height - q;
    const std::uint32_t pieces = detail::piece_count(0.5 * pi * q, edge, facets, 4);
    const bool has_flat_ends = r - q > 1e-9 * r;
    Profile profile{{has_flat_ends ? r - q : 0.0, -0.5 * b.height}};
    if (q > 0.0) detail::add_arc(profile, {r - q, -z}, q, -0.5 * pi, 0.0, pieces);
    if (side > 1e-9 * b.height) detail::add_line(profile, {r, z}, detail::piece_count(side, edge, facets));
    if (q > 0.0) detail::add_arc(profile, {r - q, z}, q, 0.0, 0.5 * pi, pieces);
    if (!has_flat_ends) profile.back().r = 0.0;
    return finished(profile, facets, volume_exact, exact_volume(b));
}

TriangleMesh make_pellet(const BevelledCylinder& b, std::uint32_t facets, bool volume_exact) {
    require_valid(b);
    detail::require_facets(facets);
    const double r = 0.5 * b.diameter, edge = edge_of(b.diameter, facets), z = 0.5 * b.height - b.bevel_height;
    const std::uint32_t pieces = detail::piece_count(std::hypot(b.bevel_width, b.bevel_height), edge, facets);
    Profile profile{{r - b.bevel_width, -0.5 * b.height}};
    detail::add_line(profile, {r, -z}, pieces);
    if (z > 1e-9 * b.height) detail::add_line(profile, {r, z}, detail::piece_count(2.0 * z, edge, facets));
    detail::add_line(profile, {r - b.bevel_width, 0.5 * b.height}, pieces);
    return finished(profile, facets, volume_exact, exact_volume(b));
}

TriangleMesh make_pellet(const DomedCylinder& b, std::uint32_t facets, bool volume_exact) {
    require_valid(b);
    detail::require_facets(facets);
    const double r = 0.5 * b.diameter, h = b.dome_height, edge = edge_of(b.diameter, facets), z = 0.5 * b.band_height;
    const double sphere = (r * r + h * h) / (2.0 * h);  // radius of the dome
    const double rim = std::atan2(sphere - h, r);       // polar angle of the rim seen from the dome's centre
    const std::uint32_t pieces = detail::piece_count(sphere * (0.5 * pi - rim), edge, facets, 4);
    Profile profile{{0.0, -z - h}};
    detail::add_arc(profile, {0.0, -z - h + sphere}, sphere, -0.5 * pi, -rim, pieces);
    profile.back() = {r, -z};
    if (b.band_height > 1e-9 * r) detail::add_line(profile, {r, z}, detail::piece_count(b.band_height, edge, facets));
    detail::add_arc(profile, {0.0, z + h - sphere}, sphere, rim, 0.5 * pi, pieces);
    profile.back() = {0.0, z + h};
    return finished(profile, facets, volume_exact, exact_volume(b));
}

TriangleMesh make_pellet(const Capsule& b, std::uint32_t facets, bool volume_exact) {
    require_valid(b);
    TriangleMesh mesh = make_pellet(DomedCylinder{b.diameter, b.length - b.diameter, 0.5 * b.diameter}, facets, volume_exact);
    return mesh;
}

TriangleMesh make_pellet(const HollowCylinder& b, std::uint32_t facets, bool volume_exact) {
    require_valid(b);
    detail::require_facets(facets);
    const double outer = 0.5 * b.outer_diameter, inner = 0.5 * b.inner_diameter, edge = edge_of(b.outer_diameter, facets);
    const std::uint32_t rows = detail::piece_count(b.height, edge, facets), rings = detail::piece_count(outer - inner, edge, facets);
    // Once round the cross-section: up the outer side, inward over the top, down the bore, outward below.
    Profile profile{{outer, -0.5 * b.height}};
    detail::add_line(profile, {outer, 0.5 * b.height}, rows);
    detail::add_line(profile, {inner, 0.5 * b.height}, rings);
    detail::add_line(profile, {inner, -0.5 * b.height}, rows);
    detail::add_line(profile, {outer, -0.5 * b.height}, rings);
    profile.pop_back();
    TriangleMesh mesh;
    std::vector<detail::Ring> all;
    for (const detail::ProfilePoint& p : profile) all.push_back(detail::add_ring(mesh, facets, p.r, p.z));
    for (std::size_t i = 0; i < all.size(); ++i) detail::add_band(mesh, all[i], all[(i + 1) % all.size()]);
    if (volume_exact) detail::scale_radii_to_volume(mesh, exact_volume(b));
    return mesh;
}

TriangleMesh stretched(TriangleMesh mesh, const Vec3& factors) {
    for (int axis = 0; axis < 3; ++axis) detail::require_positive(factors[axis], "stretch");
    for (Vec3& v : mesh.vertices) v = v.cwiseProduct(factors);
    return mesh;
}

}  // namespace pelletlab::meshes
