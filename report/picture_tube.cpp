#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "report/detail/bed_scene.hpp"
#include "report/detail/fit_camera.hpp"
#include "report/detail/page.hpp"

namespace pelletlab::report {
namespace {

struct TubeView {
    Vec3 axis = Vec3::Zero();  // [m], a point of the axis at z = 0
    double radius = 0.0, floor = 0.0, top = 0.0;
    bool goes_on = false;  // above the picture
};

/// The part of the tube that is shown: from the floor to a little above the bed, or to the rim when that is near.
TubeView view_of(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings) {
    Box bed;
    double pellet = 0.0;
    for (const PelletShape& shape : header.shapes) pellet = std::max(pellet, detail::shape_radius(shape));
    for (const Vec3& position : frame.positions) {
        bed.extend(Vec3(position.array() - pellet));
        bed.extend(Vec3(position.array() + pellet));
    }
    const Box walls = detail::wall_box(header, frame), box = walls.isEmpty() ? bed : walls;
    TubeView view;
    view.axis = {box.center().x(), box.center().y(), 0.0};
    view.radius = 0.5 * std::max(box.sizes().x(), box.sizes().y());
    view.floor = box.min().z();
    view.top = settings.view_top.value_or(bed.max().z() + 0.5 * view.radius);
    const double rim = walls.isEmpty() ? bed.max().z() : walls.max().z();
    if (rim < view.floor + 1.35 * (view.top - view.floor)) view.top = rim;
    view.goes_on = rim > view.top;
    if (!(view.top > view.floor)) view.top = view.floor + view.radius;
    return view;
}

/// A tube that goes on above the picture fades into the paper under the title.
void fade_head(Image& image, double from, double to) {
    for (std::uint32_t y = 0; y < image.height && y < to; ++y) {
        const double share = std::clamp((to - y - 0.5) / (to - from), 0.0, 1.0);
        for (std::uint32_t x = 0; x < image.width; ++x) blend_pixel(image, x, y, {255, 255, 255}, share * share * (3.0 - 2.0 * share));
    }
}

std::vector<Vec3> outline_of(const TubeView& view) {
    std::vector<Vec3> points;
    constexpr int around = 48;
    for (int i = 0; i < around; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / around;
        const Vec3 rim = view.axis + view.radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
        points.emplace_back(rim.x(), rim.y(), view.floor);
        points.emplace_back(rim.x(), rim.y(), view.top);
    }
    return points;
}

}  // namespace

Image picture_of_tube(const TrajectoryHeader& header, const Frame& frame, const PelletValues& values, const PictureSettings& settings) {
    detail::check_frame(header, frame, values);
    const detail::Page page(settings.width);
    const ValueRange range = settings.range.value_or(detail::automatic_range(values.value, 1.0));
    const TubeView view = view_of(header, frame, settings);

    constexpr double elevation = 0.20, field_of_view = 0.24;  // [rad]: a calm, nearly parallel view from a little above
    const Vec3 forward(std::cos(elevation) * std::sin(settings.azimuth), std::cos(elevation) * std::cos(settings.azimuth), -std::sin(elevation));
    const std::vector<Vec3> outline = outline_of(view);
    const double bar = detail::bar_column(values, range, settings.width);
    // The tube stands in the middle between the left margin and the colour bar; the paper is as high as the tube needs.
    const double tube_width = 0.62 * settings.width, head = 2.0 * page.margin + page.title.cap_height, foot = 1.4 * page.margin;
    const double wanted = tube_width * detail::aspect(outline, forward, Vec3::UnitZ()) + head + foot;
    const auto height = static_cast<std::uint32_t>(std::lround(std::clamp(wanted, 0.6 * settings.width, 1.4 * settings.width)));
    const double middle = 0.5 * (settings.width - bar + 0.5 * page.margin);
    const detail::Viewport viewport{middle - 0.5 * tube_width, head, middle + 0.5 * tube_width, height - foot};
    const Camera camera = detail::fit_camera(outline, forward, Vec3::UnitZ(), field_of_view, settings.width, height, viewport);

    Scene scene;
    scene.objects = detail::pellets(header, frame, values, range, settings.draw_spheres);
    for (SceneObject& wall : detail::glass_walls(header, frame)) scene.objects.push_back(std::move(wall));
    scene.ground = true;
    scene.ground_level = view.floor;
    Image image = render(scene, camera, settings.width, height, settings.samples);
    if (view.goes_on) fade_head(image, 0.75 * head, 1.6 * head);
    detail::finish_bed_picture(image, header, frame, values, range, settings);
    return image;
}

Image picture_of_tube(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings) {
    constexpr double millimetre = 1e-3;
    const Box walls = frame.wall_poses.size() == header.walls.size() ? detail::wall_box(header, frame) : Box();
    const double floor = walls.isEmpty() ? 0.0 : walls.min().z();
    PelletValues values;
    values.label = "height (mm)";
    for (const Vec3& position : frame.positions) values.value.push_back((position.z() - floor) / millimetre);
    PictureSettings in_millimetres = settings;
    if (settings.range) in_millimetres.range = ValueRange{settings.range->lower / millimetre, settings.range->upper / millimetre};
    return picture_of_tube(header, frame, values, in_millimetres);
}

}  // namespace pelletlab::report
