// From pixels to rays and back: the geometry of the camera, in world coordinates [m].
#pragma once

#include <array>
#include <optional>

#include "report/render.hpp"

namespace pelletlab::report::detail {

/// Right-handed: right × up = −forward.
struct CameraFrame {
    Vec3 right, up, forward;
    double distance = 0.0;  ///< [m], eye to target
};

/// Throws Error(bad_input) when eye and target coincide, `up` lies along the view, or the opening is out of range.
CameraFrame camera_frame(const Camera& camera);

struct Ray {
    Vec3 origin, direction;  ///< direction is a unit vector
};

/// Ray through the point (x, y) of the picture, in pixels from its upper left corner; pixel (i, j) covers [i, i+1) × [j, j+1).
class CameraRays {
public:
    CameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height);
    Ray ray(double x, double y) const;
    /// Picture coordinates [pixel] of a point, nothing for one behind a perspective camera.
    std::optional<std::array<double, 2>> project(const Vec3& p_world) const;
    /// Edge of a pixel [m] at the distance of the camera's target.
    double pixel_size() const { return height_at_target_ / height_; }
    const CameraFrame& frame() const { return frame_; }

private:
    Camera camera_;
    CameraFrame frame_;
    double width_, height_;    ///< [pixel]
    double height_at_target_;  ///< [m]
};

}  // namespace pelletlab::report::detail
