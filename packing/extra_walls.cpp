#include "packing/extra_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshes/makers.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::packing {

namespace {

constexpr std::uint32_t picture_facets = 96;
constexpr double upright_tilt = 0.1;  // |n_z| of a plane below which pellets start beside it, not above: it is steeper than 84°

/// The segment between (radius, height) = (r0, 0) and (r1, length) turned about the axis through `point`.
TriangleMesh revolved_mesh(const Vec3& point, const Vec3& axis, double r0, double r1, double length) {
    TriangleMesh mesh;
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    for (std::uint32_t k = 0; k < picture_facets; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / picture_facets;
        const Vec3 out = u * std::cos(angle) + v * std::sin(angle);
        mesh.vertices.push_back(point + out * r0);
        mesh.vertices.push_back(point + out * r1 + axis * length);
    }
    for (std::uint32_t k = 0; k < picture_facets; ++k) {
        const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % picture_facets);
        if (r0 > 0.0) mesh.faces.push_back({a, b, b + 1});
        if (r1 > 0.0) mesh.faces.push_back({a, b + 1, a + 1});
    }
    return mesh;
}

TriangleMesh square(const Vec3& point, const Vec3& normal, double half) {
    const Vec3 u = normal.unitOrthogonal() * half, v = normal.cross(u);
    return {{point - u - v, point + u - v, point + u + v, point - u + v}, {{0, 1, 2}, {0, 2, 3}}};
}

/// The rig's surface in closed form, in place of its facets.
void make_exact(const Case& c, std::vector<solver::WallDefinition>& walls) {
    const bool upright = c.rig == Rig::tube && !c.tube.lying;
    const double radius = 0.5 * (c.rig == Rig::drum ? c.drum.diameter : c.tube.diameter);
    const Vec3 axis = upright ? Vec3::UnitZ() : Vec3::UnitY();
    for (solver::WallDefinition& wall : walls) {
        const Box box = bounding_box(wall.mesh);  // along the axis the facets are exact
        const double low = axis.dot(box.min()), high = axis.dot(box.max());
        if (wall.name == "shell") wall.exact = solver::exact_cylinder(Vec3::Zero(), axis, radius, low, high);
        if (wall.name == "floor" || wall.name == "front" || wall.name == "back") wall.exact = solver::exact_disc(axis * low, axis, radius);
    }
}

/// Height of the highest point that a wall has over the circle of this radius about the z axis [m].
double top_over(const ExtraWall& w, double radius) {
    if (w.shape == "box") return w.point.z() + 0.5 * w.size.z();
    const Vec3 axis = w.axis.normalized();
    const double across = axis.head<2>().norm();
    if (w.shape == "plane") {
        const double tilt = std::abs(axis.z());
        if (tilt < upright_tilt) return -std::numeric_limits<double>::infinity();
        return w.point.z() + axis.head<2>().dot(w.point.head<2>()) / axis.z() + radius * across / tilt;  // z(x, y) = p_z − n_xy·(xy − p_xy) / n_z
    }
    const double far_radius = w.shape == "cone" ? w.far_radius : w.radius, length = w.shape == "disc" ? 0.0 : w.length;
    return std::max(w.point.z() + w.radius * across, w.point.z() + length * axis.z() + far_radius * across);
}

}  // namespace

void add_walls_of_case(const Case& c, std::vector<solver::WallDefinition>& walls) {
    if ((c.rig == Rig::tube && c.tube.surface == "exact") || (c.rig == Rig::drum && c.drum.surface == "exact")) make_exact(c, walls);
    Box rig;
    for (const solver::WallDefinition& wall : walls) rig.extend(bounding_box(wall.mesh));
    for (const auto& [name, w] : c.walls) {
        solver::WallDefinition wall = define_wall(c, name, {}, w.material);
        const Vec3 axis = w.shape == "box" ? Vec3::UnitZ() : Vec3(w.axis.normalized());
        if (w.shape == "plane") {
            wall.exact = solver::exact_plane(w.point, axis);
            const Vec3 middle = rig.center() - axis * axis.dot(rig.center() - w.point);
            wall.mesh = square(middle, axis, rig.diagonal().norm());
        } else if (w.shape == "box") {
            wall.exact = solver::exact_box(w.point - 0.5 * w.size, w.point + 0.5 * w.size);
            wall.mesh = meshes::make_box(w.point - 0.5 * w.size, w.point + 0.5 * w.size);
        } else if (w.shape == "disc") {
            wall.exact = solver::exact_disc(w.point, axis, w.radius);
            wall.mesh = revolved_mesh(w.point, axis, 0.0, w.radius, 0.0);
        } else {
            const double far_radius = w.shape == "cone" ? w.far_radius : w.radius;
            wall.exact = solver::exact_cone(w.point, axis, w.radius, 0.0, far_radius, w.length);
            wall.mesh = revolved_mesh(w.point, axis, w.radius, far_radius, w.length);
        }
        walls.push_back(std::move(wall));
    }
}

double top_of_extra_walls(const Case& c, double radius) {
    double top = 0.0;
    for (const auto& [ignored, wall] : c.walls) top = std::max(top, top_over(wall, radius));
    return top;
}

bool turns_with_vessel(const Case& c, const std::string& wall) {
    if (const auto extra = c.walls.find(wall); extra != c.walls.end()) return extra->second.turns;
    return c.rig != Rig::drum || c.drum.end_plates_rotate || wall == "shell";
}

}  // namespace pelletlab::packing
