#include "report/detail/camera_rays.hpp"

#include <cmath>

#include "core/error.hpp"

namespace pelletlab::report::detail {

CameraFrame camera_frame(const Camera& camera) {
    const Vec3 view = camera.target - camera.eye;
    const double distance = view.norm();
    if (!view.allFinite() || !camera.up.allFinite() || !(distance > 0.0)) throw bad_input("the camera's eye and target must be two different, finite points");
    CameraFrame frame;
    frame.distance = distance;
    frame.forward = view / distance;
    const Vec3 right = frame.forward.cross(camera.up);
    if (!(right.norm() > 1e-9 * camera.up.norm())) throw bad_input("the camera looks along its own «up» direction", "turn one of them");
    frame.right = right.normalized();
    frame.up = frame.right.cross(frame.forward);
    const bool parallel = camera.field_of_view == 0.0;
    if (parallel ? !(camera.height > 0.0 && std::isfinite(camera.height)) : !(camera.field_of_view > 0.0 && camera.field_of_view < 3.1))
        throw bad_input("the camera needs a field of view between 0 and 3.1 rad, or 0 and a positive height for parallel projection");
    return frame;
}

CameraRays::CameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height)
    : camera_(camera),
      frame_(camera_frame(camera)),
      width_(width),
      height_(height),
      height_at_target_(camera.field_of_view == 0.0 ? camera.height : 2.0 * frame_.distance * std::tan(0.5 * camera.field_of_view)) {}

Ray CameraRays::ray(double x, double y) const {
    const double to_right = (x - 0.5 * width_) * pixel_size(), to_top = (0.5 * height_ - y) * pixel_size();
    const Vec3 shift = to_right * frame_.right + to_top * frame_.up;
    if (camera_.field_of_view == 0.0) return {camera_.eye + shift, frame_.forward};
    return {camera_.eye, (frame_.distance * frame_.forward + shift).normalized()};
}

std::optional<std::array<double, 2>> CameraRays::project(const Vec3& p_world) const {
    const Vec3 from_eye = p_world - camera_.eye;
    const double depth = from_eye.dot(frame_.forward);
    const bool parallel = camera_.field_of_view == 0.0;
    if (!parallel && depth <= 0.0) return std::nullopt;
    const double pixels = (parallel ? 1.0 : frame_.distance / depth) / pixel_size();
    return std::array<double, 2>{0.5 * width_ + pixels * from_eye.dot(frame_.right), 0.5 * height_ - pixels * from_eye.dot(frame_.up)};
}

}  // namespace pelletlab::report::detail
