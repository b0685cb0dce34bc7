#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "report/detail/bed_scene.hpp"
#include "report/detail/fit_camera.hpp"
#include "report/detail/page.hpp"

namespace pelletlab::report {
namespace {

constexpr double shown_share = 0.97;  // of the pellets on the plate that lie in the picture; a few roll far away

/// Distance from the axis and height [m] that hold most of what lies on the plate.
struct PileView {
    double radius = 0.0, top = 0.0;
};

PileView view_of(const TrajectoryHeader& header, const Frame& frame) {
    double pellet = 0.0;
    for (const PelletShape& shape : header.shapes) pellet = std::max(pellet, detail::shape_radius(shape));
    std::vector<double> radius, height;
    for (const Vec3& p : frame.positions)
        if (p.allFinite() && p.z() >= 0.0) radius.push_back(std::hypot(p.x(), p.y())), height.push_back(p.z());
    if (radius.empty()) throw bad_input("no pellet lies on or above the plate: there is no pile to draw");
    const auto at = static_cast<std::ptrdiff_t>(shown_share * static_cast<double>(radius.size() - 1));
    std::nth_element(radius.begin(), radius.begin() + at, radius.end());
    return {radius[static_cast<std::size_t>(at)] + 2.0 * pellet, *std::max_element(height.begin(), height.end()) + pellet};
}

std::vector<Vec3> outline_of(const PileView& view) {
    std::vector<Vec3> points;
    constexpr int around = 48;
    for (int i = 0; i < around; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / around;
        points.emplace_back(view.radius * std::cos(angle), view.radius * std::sin(angle), 0.0);
        points.emplace_back(0.2 * view.radius * std::cos(angle), 0.2 * view.radius * std::sin(angle), view.top);
    }
    return points;
}

}  // namespace

Image picture_of_pile(const TrajectoryHeader& header, const Frame& frame, const PictureSettings& settings) {
    PelletValues values;
    values.label = "height (mm)";
    for (const Vec3& position : frame.positions) values.value.push_back(1e3 * position.z());
    detail::check_frame(header, frame, values);
    const detail::Page page(settings.width);
    const ValueRange range = settings.range ? ValueRange{1e3 * settings.range->lower, 1e3 * settings.range->upper} : detail::automatic_range(values.value, 1.0);

    constexpr double elevation = 0.30, field_of_view = 0.24;  // [rad]
    const Vec3 forward(std::cos(elevation) * std::sin(settings.azimuth), std::cos(elevation) * std::cos(settings.azimuth), -std::sin(elevation));
    const std::vector<Vec3> outline = outline_of(view_of(header, frame));
    const double bar = detail::bar_column(values, range, settings.width), head = 2.0 * page.margin + page.title.cap_height;
    const double room = settings.width - bar - 1.5 * page.margin;
    const double wanted = room * detail::aspect(outline, forward, Vec3::UnitZ()) + head + page.margin;
    const auto height = static_cast<std::uint32_t>(std::lround(std::clamp(wanted, 0.45 * settings.width, 1.3 * settings.width)));
    const Camera camera = detail::fit_camera(outline, forward, Vec3::UnitZ(), field_of_view, settings.width, height,
                                             {page.margin, head, page.margin + room, height - page.margin});
    Scene scene;
    scene.objects = detail::pellets(header, frame, values, range, settings.draw_spheres);
    scene.ground = true;
    Image image = render(scene, camera, settings.width, height, settings.samples);
    detail::finish_bed_picture(image, header, frame, values, range, settings);
    return image;
}

}  // namespace pelletlab::report
