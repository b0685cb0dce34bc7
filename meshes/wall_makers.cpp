// Walls of the rigs: tube, drum, funnel and baffle. A wall triangle is one plane facet high, because a contact on a longer triangle is still exact and fewer
// triangles mean fewer edges to decide about.
#include <cmath>
#include <numbers>

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

double funnel_cone_height(double outlet_diameter, double top_diameter, double half_angle) {
    return 0.5 * (top_diameter - outlet_diameter) / std::tan(half_angle);
}

TriangleMesh make_funnel(double outlet_diameter, double top_diameter, double half_angle, double bottom, double top, std::uint32_t facets) {
    detail::require_positive(outlet_diameter, "outlet diameter");
    detail::require_positive(top_diameter - outlet_diameter, "top diameter minus outlet diameter");
    detail::require_positive(half_angle, "half angle");
    detail::require_positive(0.5 * std::numbers::pi - half_angle, "right angle minus half angle");
    const double shoulder = bottom + funnel_cone_height(outlet_diameter, top_diameter, half_angle);
    detail::require_positive(top - shoulder, "height of the cylinder above the cone");
    detail::require_facets(facets);
    TriangleMesh mesh;
    const detail::Ring outlet = detail::add_ring(mesh, facets, corner_radius(0.5 * outlet_diameter, facets), bottom);
    const detail::Ring middle = detail::add_ring(mesh, facets, corner_radius(0.5 * top_diameter, facets), shoulder);
    const detail::Ring rim = detail::add_ring(mesh, facets, corner_radius(0.5 * top_diameter, facets), top);
    detail::add_band(mesh, outlet, middle);
    detail::add_band(mesh, middle, rim);
    detail::flip_faces(mesh);
    return mesh;
}

TriangleMesh make_baffle(double drum_diameter, double length, double height, double thickness, double angle) {
    detail::require_positive(drum_diameter, "diameter");
    detail::require_positive(length, "length");
    detail::require_positive(height, "height");
    detail::require_positive(thickness, "thickness");
    const double radius = 0.5 * drum_diameter;
    detail::require_positive(radius - height, "radius minus height");
    TriangleMesh mesh = make_box({-0.5 * thickness, -0.5 * length, -radius}, {0.5 * thickness, 0.5 * length, height - radius});
    const Eigen::AngleAxisd turn(angle, Vec3::UnitY());
    for (Vec3& vertex : mesh.vertices) vertex = turn * vertex;
    return mesh;
}

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Triangle& face : other.faces) mesh.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
    return mesh;
}

}  // namespace pelletlab::meshes
