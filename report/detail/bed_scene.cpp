#include "report/detail/bed_scene.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "report/detail/page.hpp"

namespace pelletlab::report::detail {

void check_frame(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values) {
    const std::size_t bodies = frame.positions.size();
    if (bodies == 0) throw bad_input("the frame to draw holds no pellets");
    if (frame.orientations.size() != bodies || header.shape_of_body.size() != bodies || values.value.size() != bodies)
        throw bad_input("the frame to draw holds " + std::to_string(bodies) + " positions, " + std::to_string(frame.orientations.size()) + " orientations, " +
                        std::to_string(header.shape_of_body.size()) + " shapes and " + std::to_string(values.value.size()) + " values to colour by");
    if (frame.wall_poses.size() != header.walls.size())
        throw bad_input("the frame to draw holds " + std::to_string(frame.wall_poses.size()) + " wall poses for " + std::to_string(header.walls.size()) +
                        " walls");
    for (const std::uint32_t shape : header.shape_of_body)
        if (shape >= header.shapes.size()) throw bad_input("a pellet has shape " + std::to_string(shape) + ", which the trajectory does not hold");
}

std::vector<SceneObject> pellets(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const ValueRange& range, bool draw_spheres) {
    std::vector<SceneObject> objects(header.shapes.size());
    for (std::size_t s = 0; s < objects.size(); ++s) {
        const PelletShape& shape = header.shapes[s];
        if (draw_spheres || shape.surface_body.empty())
            objects[s].spheres = shape.rigid.spheres;
        else
            objects[s].mesh = shape.surface_body;
    }
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
        SceneObject& object = objects[header.shape_of_body[i]];
        object.poses.push_back({frame.positions[i], frame.orientations[i]});
        object.colours.push_back(map_colour(values.map, range.fraction(values.value[i])));
    }
    return objects;
}

std::vector<SceneObject> glass_walls(const TrajectoryHeader& header, const Frame& frame) {
    std::vector<SceneObject> objects;
    for (std::size_t w = 0; w < header.walls.size(); ++w) {
        SceneObject wall;
        wall.mesh = header.walls[w].mesh;
        wall.poses = {frame.wall_poses[w]};
        wall.glass = true;
        objects.push_back(std::move(wall));
    }
    return objects;
}

Box wall_box(const TrajectoryHeader& header, const Frame& frame) {
    Box box;
    for (std::size_t w = 0; w < header.walls.size(); ++w)
        for (const Vec3& vertex : header.walls[w].mesh.vertices) box.extend(frame.wall_poses[w].to_world(vertex));
    return box;
}

double shape_radius(const PelletShape& shape) {
    double radius = shape.rigid.spheres.empty() ? 0.0 : bounding_radius(shape.rigid.spheres);
    for (const Vec3& vertex : shape.surface_body.vertices) radius = std::max(radius, vertex.norm());
    return radius;
}

ValueRange automatic_range(const std::vector<double>& values, double share) {
    std::vector<double> sorted;
    for (const double value : values)
        if (std::isfinite(value)) sorted.push_back(value);
    if (sorted.empty()) return {0.0, 1.0};
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&sorted](double part) { return sorted[static_cast<std::size_t>(std::lround(part * static_cast<double>(sorted.size() - 1)))]; };
    const double lower = at(1.0 - share), upper = at(share);
    const auto away_from_zero = [](double value) { return value == 0.0 ? 0.0 : std::copysign(round_up(std::abs(value)), value); };
    ValueRange range{std::min(0.0, away_from_zero(std::min(0.0, lower))), away_from_zero(std::max(0.0, upper))};
    if (!(range.lower < range.upper)) range.upper = range.lower + 1.0;  // all zero: a resting bed coloured by speed
    return range;
}

namespace {

ColourBar bar_of(const PelletValues& values, const ValueRange& range) {
    ColourBar bar{values.map, range, values.label, false, false};
    const double slack = 1e-9 * (range.upper - range.lower);
    for (const double value : values.value) {
        bar.some_below |= value < range.lower - slack;
        bar.some_above |= value > range.upper + slack;
    }
    return bar;
}

std::string title_of(const TrajectoryHeader& header, const Frame& frame) {
    const std::string name = header.case_name.empty() ? "" : header.case_name + ": ";
    return name + std::to_string(frame.positions.size()) + " pellets, t = " + time_text(frame.time);
}

}  // namespace

double bar_column(const PelletValues& values, const ValueRange& range, std::uint32_t width) {
    const Page page(width);
    return colour_bar_width(bar_of(values, range), page.bar_width, page.text) + 2.0 * page.margin;
}

void finish_bed_picture(Image& image, const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const ValueRange& range,
                        const PictureSettings& settings) {
    const Page page(image.width);
    draw_text(image, page.margin, page.margin + page.title.cap_height, settings.title.value_or(title_of(header, frame)), page.title);
    const double left = image.width - bar_column(values, range, image.width) + page.margin;
    const double height = std::min(0.5 * image.height, 420.0 * page.unit);
    draw_colour_bar(image, bar_of(values, range), left, 0.5 * (image.height - height), page.bar_width, height, page.text);
}

}  // namespace pelletlab::report::detail
