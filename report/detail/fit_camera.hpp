// Where to stand so that everything is in the picture.
#pragma once

#include <span>

#include "report/render.hpp"

namespace pelletlab::report::detail {

/// Part of the picture that the points shall fill, [pixel] from the upper left corner.
struct Viewport {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
};

/// Camera that looks along `forward` and shows the points centred in the viewport, as large as it allows. A vertical field of view of 0 means parallel
/// projection.
Camera fit_camera(std::span<const Vec3> points, const Vec3& forward, const Vec3& up, double field_of_view, std::uint32_t width, std::uint32_t height,
                  const Viewport& viewport);

/// Height / width of the points' bounding rectangle in parallel projection along `forward`.
double aspect(std::span<const Vec3> points, const Vec3& forward, const Vec3& up);

}  // namespace pelletlab::report::detail
