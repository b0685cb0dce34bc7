#include "report/detail/fit_camera.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "report/detail/camera_rays.hpp"

namespace pelletlab::report::detail {
namespace {

using Rectangle = Eigen::AlignedBox2d;

Rectangle on_picture(std::span<const Vec3> points, const CameraRays& rays) {
    Rectangle rectangle;
    for (const Vec3& point : points) {
        const auto pixel = rays.project(point);
        if (pixel) rectangle.extend(Eigen::Vector2d((*pixel)[0], (*pixel)[1]));
    }
    return rectangle;
}

}  // namespace

Camera fit_camera(std::span<const Vec3> points, const Vec3& forward, const Vec3& up, double field_of_view, std::uint32_t width, std::uint32_t height,
                  const Viewport& viewport) {
    Box box;
    for (const Vec3& point : points) box.extend(point);
    const double size = box.isEmpty() ? 0.0 : box.diagonal().norm();
    if (!(size > 0.0)) throw bad_input("the picture shows nothing that has a size");
    // Far enough for every point to lie in front of the eye; the loop then comes closer.
    const double distance = field_of_view == 0.0 ? 2.0 * size : size / std::tan(0.5 * field_of_view);
    Camera camera{box.center() - distance * forward, box.center(), up, field_of_view, 2.0 * size};
    for (int round = 0; round < 25; ++round) {  // each round shrinks the misfit several times
        const CameraRays rays(camera, width, height);
        const Rectangle shown = on_picture(points, rays);
        const double ratio = std::max(shown.sizes().x() / (viewport.right - viewport.left), shown.sizes().y() / (viewport.bottom - viewport.top));
        const double to_right = (shown.center().x() - 0.5 * (viewport.left + viewport.right)) * rays.pixel_size();
        const double to_top = (0.5 * (viewport.top + viewport.bottom) - shown.center().y()) * rays.pixel_size();
        camera.target += to_right * rays.frame().right + to_top * rays.frame().up;
        const double next = field_of_view == 0.0 ? distance : (camera.target - camera.eye).dot(forward) * ratio;
        camera.height *= ratio;
        camera.eye = camera.target - next * forward;
    }
    return camera;
}

double aspect(std::span<const Vec3> points, const Vec3& forward, const Vec3& up) {
    const Vec3 right = forward.cross(up).normalized(), top = right.cross(forward);
    Rectangle rectangle;
    for (const Vec3& point : points) rectangle.extend(Eigen::Vector2d(point.dot(right), point.dot(top)));
    return rectangle.isEmpty() || !(rectangle.sizes().x() > 0.0) ? 1.0 : rectangle.sizes().y() / rectangle.sizes().x();
}

}  // namespace pelletlab::report::detail
