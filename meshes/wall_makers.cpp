// Walls of the rigs: tube and drum. A wall triangle is one plane facet high, because a contact on a longer triangle is still exact and fewer
// triangles mean fewer edges to decide about.
#include <cmath>

#include "meshes/detail/require.hpp"
#include "meshes/detail/rings.hpp"
#include "meshes/makers.hpp"

namespace pelletlab::meshes {
namespace {

/// Corners of the polygon circumscribed about a circle of that radius.
double corner_radius(double radius, std::uint32_t facets) {
    return radius * detail::circumscribed_factor(facets);
}

/// (x, y, z) → (x, z, −y): a quarter turn about x that takes the axis z to y. A rotation, so orientation stays.
TriangleMesh axis_z_to_y(TriangleMesh mesh) {
    for (Vec3& vertex : mesh.vertices) vertex = Vec3(vertex.x(), vertex.z(), -vertex.y() + 0.0);
    return mesh;
}

}  // namespace

TriangleMesh make_tube_shell(double diameter, double bottom, double top, std::uint32_t facets) {
    detail::require_positive(diameter, "diameter");
    detail::require_positive(top - bottom, "height");
    detail::require_facets(facets);
    TriangleMesh mesh;
    const detail::Ring lower = detail::add_ring(mesh, facets, corner_radius(0.5 * diameter, facets), bottom);
    const detail::Ring upper = detail::add_ring(mesh, facets, corner_radius(0.5 * diameter, facets), top);
    detail::add_band(mesh, lower, upper);
    detail::flip_faces(mesh);  // towards the axis
    return mesh;
}

TriangleMesh make_disc(double radius, double level, bool facing_up, std::uint32_t facets) {
    detail::require_positive(radius, "radius");
    detail::require_facets(facets);
    TriangleMesh mesh;
    const detail::Ring rim = detail::add_ring(mesh, facets, corner_radius(radius, facets), level);
    mesh.vertices.emplace_back(0.0, 0.0, level);
    for (std::uint32_t k = 0; k < facets; ++k) mesh.faces.push_back({rim.at(k), rim.at(k + 1), facets});
    if (!facing_up) detail::flip_faces(mesh);
    return mesh;
}

TriangleMesh make_drum_shell(double diameter, double length, std::uint32_t facets) {
    detail::require_positive(length, "length");
    return axis_z_to_y(make_tube_shell(diameter, -0.5 * length, 0.5 * length, facets));
}

TriangleMesh make_drum_end(double diameter, double y, bool facing_positive_y, std::uint32_t facets) {
    return axis_z_to_y(make_disc(0.5 * diameter, y, facing_positive_y, facets));
}

}  // namespace pelletlab::meshes
