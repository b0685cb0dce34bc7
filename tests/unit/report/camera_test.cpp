#include <gtest/gtest.h>

#include "core/error.hpp"
#include "report/detail/camera_rays.hpp"
#include "report/detail/fit_camera.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

Camera some_camera(double field_of_view) {
    return {{0.3, -2.0, 0.9}, {0.1, 0.2, -0.1}, Vec3::UnitZ(), field_of_view, 1.7};
}

TEST(Camera, ProjectionUndoesTheRay) {
    for (const double field_of_view : {0.0, 0.5}) {
        const detail::CameraRays rays(some_camera(field_of_view), 640, 480);
        for (const double x : {0.0, 123.4, 639.0})
            for (const double y : {1.5, 240.0, 479.9}) {
                const detail::Ray ray = rays.ray(x, y);
                const auto back = rays.project(ray.origin + 1.7 * ray.direction);
                ASSERT_TRUE(back.has_value());
                EXPECT_NEAR((*back)[0], x, 1e-9);
                EXPECT_NEAR((*back)[1], y, 1e-9);
            }
    }
}

TEST(Camera, RightIsRightAndUpIsUp) {
    const detail::CameraRays rays(testing::parallel_camera(2.0), 200, 100);  // looks along +y: x to the right, z up
    const auto right = rays.project({0.5, 0.0, 0.0}), top = rays.project({0.0, 0.0, 0.5});
    EXPECT_NEAR((*right)[0], 125.0, 1e-9);
    EXPECT_NEAR((*right)[1], 50.0, 1e-9);
    EXPECT_NEAR((*top)[0], 100.0, 1e-9);
    EXPECT_NEAR((*top)[1], 25.0, 1e-9);
    EXPECT_NEAR(rays.pixel_size(), 0.02, 1e-15);
}

TEST(Camera, PointsBehindAPerspectiveCameraHaveNoPicture) {
    const detail::CameraRays rays(some_camera(0.5), 640, 480);
    EXPECT_FALSE(rays.project({0.4, -5.0, 2.0}).has_value());
}

TEST(Camera, RefusesViewsThatShowNothing) {
    Camera camera = some_camera(0.5);
    camera.target = camera.eye;
    EXPECT_THROW(detail::camera_frame(camera), Error);
    camera = {{0.0, 0.0, 1.0}, Vec3::Zero(), Vec3::UnitZ(), 0.5, 0.0};
    EXPECT_THROW(detail::camera_frame(camera), Error);
    camera = some_camera(0.0);
    camera.height = 0.0;
    EXPECT_THROW(detail::camera_frame(camera), Error);
    EXPECT_THROW(detail::camera_frame(some_camera(3.2)), Error);
    EXPECT_THROW(detail::camera_frame(some_camera(-0.1)), Error);
}

TEST(Camera, FitFillsTheViewport) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 3.0 : -1.0, i & 2 ? 2.0 : 0.0, i & 4 ? 1.0 : -4.0);
    const detail::Viewport viewport{50.0, 100.0, 650.0, 450.0};
    for (const double field_of_view : {0.0, 0.3, 1.0}) {
        const Camera camera = detail::fit_camera(points, Vec3(0.3, 1.0, -0.4).normalized(), Vec3::UnitZ(), field_of_view, 800, 500, viewport);
        const detail::CameraRays rays(camera, 800, 500);
        Eigen::AlignedBox2d shown;
        for (const Vec3& point : points) {
            const auto pixel = rays.project(point);
            ASSERT_TRUE(pixel.has_value());
            shown.extend(Eigen::Vector2d((*pixel)[0], (*pixel)[1]));
        }
        // The loop of fit_camera converges to far below a tenth of a pixel.
        EXPECT_NEAR(shown.center().x(), 350.0, 0.1);
        EXPECT_NEAR(shown.center().y(), 275.0, 0.1);
        EXPECT_NEAR(std::max(shown.sizes().x() / 600.0, shown.sizes().y() / 350.0), 1.0, 1e-3);
    }
    EXPECT_THROW(detail::fit_camera({}, Vec3::UnitY(), Vec3::UnitZ(), 0.3, 800, 500, viewport), Error);
}

}  // namespace
}  // namespace pelletlab::report
