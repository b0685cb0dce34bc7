#include "observables/detail/camera_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr std::size_t lanes = 4;  // frames looked at side by side; fixed, so that the order of every sum is fixed
constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// One picture: the nearest surface of each cell.
struct Picture {
    const ViewGrid& grid;
    std::vector<double> depth;        // [m], world y
    std::vector<std::uint32_t> body;  // nobody: nothing seen

    Picture(const ViewGrid& view, double deepest) : grid(view), depth(view.cells(), deepest), body(view.cells(), nobody) {}

    /// Calls y_at(x, z) for the cells whose centres lie in the box; it answers NaN where the surface is not met.
    template <class Surface>
    void draw(double x0, double x1, double z0, double z1, std::uint32_t of_body, const Surface& y_at) {
        const auto index = [](double value, double first, double step, std::size_t count, bool up) {
            const double k = up ? std::ceil((value - first) / step) : std::floor((value - first) / step);
            return static_cast<std::ptrdiff_t>(std::clamp(k, -1.0, static_cast<double>(count)));
        };
        const std::ptrdiff_t c0 = std::max<std::ptrdiff_t>(0, index(x0, grid.first_a, grid.step_a, grid.columns, true));
        const std::ptrdiff_t c1 = std::min(static_cast<std::ptrdiff_t>(grid.columns) - 1, index(x1, grid.first_a, grid.step_a, grid.columns, false));
        const std::ptrdiff_t r0 = std::max<std::ptrdiff_t>(0, index(z0, grid.first_b, grid.step_b, grid.rows, true));
        const std::ptrdiff_t r1 = std::min(static_cast<std::ptrdiff_t>(grid.rows) - 1, index(z1, grid.first_b, grid.step_b, grid.rows, false));
        for (std::ptrdiff_t r = r0; r <= r1; ++r)
            for (std::ptrdiff_t c = c0; c <= c1; ++c) {
                const auto column = static_cast<std::size_t>(c), row = static_cast<std::size_t>(r), cell = row * grid.columns + column;
                const double y = y_at(grid.centre_a(column), grid.centre_b(row));
                if (!(y < depth[cell])) continue;
                depth[cell] = y;
                body[cell] = of_body;
            }
    }
};

void draw_sphere(Picture& picture, const Vec3& centre, double radius, std::uint32_t body) {
    picture.draw(centre.x() - radius, centre.x() + radius, centre.z() - radius, centre.z() + radius, body, [&](double x, double z) {
        const double rest = radius * radius - (x - centre.x()) * (x - centre.x()) - (z - centre.z()) * (z - centre.z());
        return rest >= 0.0 ? centre.y() - std::sqrt(rest) : not_known;
    });
}

void draw_triangle(Picture& picture, const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t body) {
    // Twice the projected area, positive when the outer side looks towards −y, at the camera.
    const double twice_area = (b.x() - a.x()) * (c.z() - a.z()) - (b.z() - a.z()) * (c.x() - a.x());
    if (twice_area <= 0.0) return;
    picture.draw(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()}), body,
                 [&](double x, double z) {
                     const double wa = (b.x() - x) * (c.z() - z) - (b.z() - z) * (c.x() - x);
                     const double wb = (c.x() - x) * (a.z() - z) - (c.z() - z) * (a.x() - x);
                     const double wc = twice_area - wa - wb, rounding = -1e-12 * twice_area;
                     return wa >= rounding && wb >= rounding && wc >= rounding ? (wa * a.y() + wb * b.y() + wc * c.y()) / twice_area : not_known;
                 });
}

/// Distance of the furthest surface point from the centre of mass, a shape [m].
std::vector<double> reaches(const TrajectoryHeader& header) {
    std::vector<double> reach;
    for (const PelletShape& shape : header.shapes) {
        double furthest = shape.surface_body.empty() ? bounding_radius(shape.rigid.spheres) : 0.0;
        for (const Vec3& vertex : shape.surface_body.vertices) furthest = std::max(furthest, vertex.norm());
        reach.push_back(furthest);
    }
    return reach;
}

void add_picture(const Frame& frame, const TrajectoryHeader& header, const std::vector<double>& reach, double deepest, CameraSums& sums) {
    Picture picture(sums.grid, deepest);
    std::vector<Vec3> vertices;
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        if (!frame.is_tracked(body) || frame.positions[body].y() - reach[header.shape_of_body[body]] >= deepest) continue;
        const PelletShape& shape = header.shapes[header.shape_of_body[body]];
        const Pose pose{frame.positions[body], frame.orientations[body]};
        const auto number = static_cast<std::uint32_t>(body);
        if (shape.surface_body.empty()) {
            for (const Sphere& sphere : shape.rigid.spheres)
                if (const Vec3 centre = pose.to_world(sphere.centre); centre.y() - sphere.radius < deepest) draw_sphere(picture, centre, sphere.radius, number);
            continue;
        }
        vertices.clear();
        const Mat3 rotation = pose.orientation.toRotationMatrix();
        for (const Vec3& vertex : shape.surface_body.vertices) vertices.push_back(rotation * vertex + pose.position);
        for (const Triangle& face : shape.surface_body.faces) draw_triangle(picture, vertices[face[0]], vertices[face[1]], vertices[face[2]], number);
    }
    for (std::size_t row = 0; row < sums.grid.rows; ++row)
        for (std::size_t column = 0; column < sums.grid.columns; ++column) {
            const std::size_t cell = row * sums.grid.columns + column;
            const std::uint32_t body = picture.body[cell];
            if (body == nobody) continue;
            const Vec3 arm = Vec3(sums.grid.centre_a(column), picture.depth[cell], sums.grid.centre_b(row)) - frame.positions[body];
            const Vec3 velocity = frame.velocities[body] + frame.spins[body].cross(arm);
            sums.seen[cell] += 1.0;
            sums.velocity_x[cell] += velocity.x();
            sums.velocity_z[cell] += velocity.z();
            sums.square[cell] += velocity.x() * velocity.x() + velocity.z() * velocity.z();
        }
    sums.frames += 1.0;
}

}  // namespace

CameraSums look(const FrameSource& trajectory, const std::vector<std::size_t>& frames, const CameraSettings& settings) {
    const auto side = static_cast<std::size_t>(std::ceil(2.0 * settings.radius / settings.grid));
    CameraSums empty;
    empty.grid = ViewGrid::over(0.5 * static_cast<double>(side) * settings.grid, side, side);
    for (auto* list : {&empty.seen, &empty.velocity_x, &empty.velocity_z, &empty.square}) list->assign(empty.grid.cells(), 0.0);
    std::vector<CameraSums> parts(lanes, empty);
    const std::vector<double> reach = reaches(trajectory.header());
    for (std::size_t first = 0; first < frames.size(); first += lanes) {
        const std::size_t side_by_side = std::min(lanes, frames.size() - first);
        std::vector<Frame> now(side_by_side);  // read in turn: a file cannot be read from two threads
        for (std::size_t lane = 0; lane < side_by_side; ++lane) now[lane] = trajectory.frame(frames[first + lane]);
        parallel_for(side_by_side, 1,
                     [&](std::size_t lane) { add_picture(now[lane], trajectory.header(), reach, settings.front + settings.depth, parts[lane]); });
    }
    for (const CameraSums& part : parts) {
        empty.frames += part.frames;
        for (std::size_t cell = 0; cell < empty.grid.cells(); ++cell) {
            empty.seen[cell] += part.seen[cell];
            empty.velocity_x[cell] += part.velocity_x[cell];
            empty.velocity_z[cell] += part.velocity_z[cell];
            empty.square[cell] += part.square[cell];
        }
    }
    return empty;
}

std::vector<FieldMap> camera_maps(const CameraSums& sums, const TimeWindow& window) {
    const auto map = [&](const char* name) {
        FieldMap m = empty_map(name, "m/s", "drum.camera_map", sums.grid, window);
        m.sample_count = sums.seen;
        return m;
    };
    FieldMap speed = map("camera_speed"), vx = map("camera_vx"), vz = map("camera_vz"), tremble = map("camera_velocity_fluctuation");
    for (std::size_t cell = 0; cell < sums.grid.cells(); ++cell) {
        const double n = sums.seen[cell];
        if (n < 1.0) continue;
        vx.value[cell] = sums.velocity_x[cell] / n;
        vz.value[cell] = sums.velocity_z[cell] / n;
        speed.value[cell] = std::hypot(vx.value[cell], vz.value[cell]);
        tremble.value[cell] = std::sqrt(std::max(0.0, sums.square[cell] / n - speed.value[cell] * speed.value[cell]));
    }
    return {std::move(speed), std::move(vx), std::move(vz), std::move(tremble)};
}

}  // namespace pelletlab::observables::detail
