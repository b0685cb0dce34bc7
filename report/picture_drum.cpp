#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "report/detail/bed_scene.hpp"
#include "report/detail/camera_rays.hpp"
#include "report/detail/fit_camera.hpp"
#include "report/detail/page.hpp"
#include "report/draw.hpp"

namespace pelletlab::report {
namespace {

/// Takes away the triangles that lie in the plane y = front: the plate between the camera and the pellets.
void remove_front_plate(SceneObject& wall, double front, double tolerance) {
    std::vector<Triangle> kept;
    for (std::size_t f = 0; f < wall.mesh.faces.size(); ++f) {
        bool in_plane = true;
        for (int k = 0; k < 3; ++k) in_plane &= std::abs(wall.poses[0].to_world(wall.mesh.corner(f, k)).y() - front) < tolerance;
        if (!in_plane) kept.push_back(wall.mesh.faces[f]);
    }
    wall.mesh.faces = std::move(kept);
}

std::vector<Vec3> outline_of(const Box& box) {
    std::vector<Vec3> points;
    constexpr int around = 64;
    for (int i = 0; i < around; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / around;
        const double x = box.center().x() + 0.5 * box.sizes().x() * std::cos(angle), z = box.center().z() + 0.5 * box.sizes().z() * std::sin(angle);
        points.emplace_back(x, box.min().y(), z);
        points.emplace_back(x, box.max().y(), z);
    }
    return points;
}

/// Scale in the lower right corner, true in the drum's middle plane.
void draw_scale(Image& image, const Camera& camera, const Vec3& centre, const detail::Page& page) {
    const detail::CameraRays rays(camera, image.width, image.height);
    const auto a = rays.project(centre), b = rays.project(centre + 1e-3 * Vec3::UnitX());
    const double pixels_per_mm = (*b)[0] - (*a)[0], room = 0.16 * image.width;
    double shown = 0.0;  // largest of 1, 2, 5 times a power of ten that fits
    for (const double digit : {1.0, 2.0, 5.0}) {
        const double candidate = digit * std::pow(10.0, std::floor(std::log10(room / pixels_per_mm / digit)));
        if (candidate * pixels_per_mm <= room) shown = std::max(shown, candidate);
    }
    const double y = image.height - page.margin, tick = 5.0 * page.unit, line = std::max(1.0, 1.5 * page.unit);
    const double right = image.width - page.margin, left = right - shown * pixels_per_mm;
    const std::vector<std::vector<Point>> strokes = {{{left, y - tick}, {left, y}, {right, y}, {right, y - tick}}};
    draw_strokes(image, strokes, line, page.text.colour);
    draw_text(image, left, y - tick - 0.7 * page.text.cap_height, tick_text(shown, shown < 1.0 ? 2 : 0) + " mm", page.text);
}

}  // namespace

Image picture_of_drum(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const PictureSettings& settings) {
    detail::check_frame(header, frame, values);
    const Box box = detail::wall_box(header, frame);
    if (box.isEmpty()) throw bad_input("the drum to draw has no walls");
    const detail::Page page(settings.width);
    const ValueRange range = settings.range.value_or(detail::automatic_range(values.value, 0.98));

    Scene scene;
    scene.objects = detail::pellets(header, frame, values, range, settings.draw_spheres);
    for (SceneObject& wall : detail::glass_walls(header, frame)) {
        remove_front_plate(wall, box.min().y(), 1e-6 * box.diagonal().norm());
        scene.objects.push_back(std::move(wall));
    }
    constexpr double field_of_view = 0.30;  // [rad]: enough to see the depth of the drum
    const std::vector<Vec3> outline = outline_of(box);
    const double bar = detail::bar_column(values, range, settings.width);
    const double head = 2.0 * page.margin + page.title.cap_height;
    const double drum_width = settings.width - bar - 1.5 * page.margin;
    const double wanted = drum_width * box.sizes().z() / box.sizes().x() + head + page.margin;
    const auto height = static_cast<std::uint32_t>(std::lround(std::clamp(wanted, 0.5 * settings.width, 1.4 * settings.width)));
    const detail::Viewport viewport{page.margin, head, page.margin + drum_width, height - page.margin};
    const Camera camera = detail::fit_camera(outline, Vec3::UnitY(), Vec3::UnitZ(), field_of_view, settings.width, height, viewport);
    Image image = render(scene, camera, settings.width, height, settings.samples);
    draw_scale(image, camera, box.center(), page);
    detail::finish_bed_picture(image, header, frame, values, range, settings);
    return image;
}

Image picture_of_drum(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings) {
    PelletValues values;
    values.label = "speed (m/s)";
    for (const Vec3& velocity : frame.velocities) values.value.push_back(velocity.norm());
    return picture_of_drum(header, frame, values, settings);
}

}  // namespace pelletlab::report
