#include "observables/detail/top_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace pelletlab::observables::detail {

namespace {

struct IndexRange {
    int first, last;
};

IndexRange grid_lines(const HeightGrid& grid, double lower, double upper) {
    const double bound = grid.half_count;
    return {static_cast<int>(std::ceil(std::clamp(lower / grid.spacing, -bound, bound + 1.0))),
            static_cast<int>(std::floor(std::clamp(upper / grid.spacing, -bound - 1.0, bound)))};
}

void raise(HeightGrid& grid, int i, int j, double z) {
    double& height = grid.height[grid.index(i, j)];
    height = std::max(height, z);
}

void raise_by_sphere(HeightGrid& grid, const Vec3& centre, double radius) {
    const IndexRange columns = grid_lines(grid, centre.x() - radius, centre.x() + radius);
    const IndexRange rows = grid_lines(grid, centre.y() - radius, centre.y() + radius);
    for (int j = rows.first; j <= rows.last; ++j)
        for (int i = columns.first; i <= columns.last; ++i) {
            const double dx = i * grid.spacing - centre.x(), dy = j * grid.spacing - centre.y();
            const double rest = radius * radius - dx * dx - dy * dy;
            if (rest >= 0.0) raise(grid, i, j, centre.z() + std::sqrt(rest));
        }
}

/// Lines through the triangle's projection, edges included: a line on an edge shared by two triangles then meets both, and none is missed.
void raise_by_triangle(HeightGrid& grid, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double twice_area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (twice_area <= 0.0) return;  // seen from below or edge on: a closed pellet has a face above it
    const IndexRange columns = grid_lines(grid, std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}));
    const IndexRange rows = grid_lines(grid, std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}));
    for (int j = rows.first; j <= rows.last; ++j)
        for (int i = columns.first; i <= columns.last; ++i) {
            const double x = i * grid.spacing, y = j * grid.spacing;
            const double wa = (b.x() - x) * (c.y() - y) - (b.y() - y) * (c.x() - x);
            const double wb = (c.x() - x) * (a.y() - y) - (c.y() - y) * (a.x() - x);
            const double wc = twice_area - wa - wb;
            const double rounding = -1e-12 * twice_area;
            if (wa >= rounding && wb >= rounding && wc >= rounding) raise(grid, i, j, (wa * a.z() + wb * b.z() + wc * c.z()) / twice_area);
        }
}

void raise_by_pellet(HeightGrid& grid, const PelletShape& shape, const Pose& pose) {
    if (shape.surface_body.empty()) {
        for (const Sphere& sphere : shape.rigid.spheres) raise_by_sphere(grid, pose.to_world(sphere.centre), sphere.radius);
        return;
    }
    std::vector<Vec3> vertices(shape.surface_body.vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = pose.to_world(shape.surface_body.vertices[v]);
    for (const Triangle& face : shape.surface_body.faces) raise_by_triangle(grid, vertices[face[0]], vertices[face[1]], vertices[face[2]]);
}

}  // namespace

HeightGrid top_surface(const TrajectoryHeader& header, const Frame& frame, std::span<const std::size_t> bodies, double extent, double spacing) {
    if (!(spacing > 0.0) || !(extent > 0.0) || extent / spacing > 20000.0)
        throw bad_input("a height grid of cells of " + std::to_string(spacing) + " m cannot cover " + std::to_string(extent) + " m",
                        "choose measurement.height_grid between a hundredth and a third of the tube's radius");
    HeightGrid grid{spacing, static_cast<int>(std::floor(extent / spacing)), {}};
    grid.height.assign(grid.side() * grid.side(), -std::numeric_limits<double>::infinity());
    // The maximum does not depend on order, so blocks may be folded in any; parallel_reduce folds them in a fixed one all the same.
    return parallel_reduce(
        bodies.size(), std::max<std::size_t>(256, bodies.size() / 16 + 1), grid,
        [&](std::size_t begin, std::size_t end) {
            HeightGrid part = grid;
            for (std::size_t k = begin; k < end; ++k) {
                const std::size_t body = bodies[k];
                raise_by_pellet(part, header.shapes[header.shape_of_body[body]], {frame.positions[body], frame.orientations[body]});
            }
            return part;
        },
        [](HeightGrid total, const HeightGrid& part) {
            for (std::size_t i = 0; i < total.height.size(); ++i) total.height[i] = std::max(total.height[i], part.height[i]);
            return total;
        });
}

}  // namespace pelletlab::observables::detail
