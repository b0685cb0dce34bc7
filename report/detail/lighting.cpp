#include "report/detail/lighting.hpp"

#include <algorithm>
#include <cmath>

#include "report/detail/camera_rays.hpp"
#include "report/image.hpp"

namespace pelletlab::report::detail {

Lighting studio(const Camera& camera) {
    const CameraFrame frame = camera_frame(camera);
    Lighting light;
    const Vec3 up = camera.up.normalized();
    light.up = up.cast<float>();
    light.to_key = (-0.50 * frame.right + 0.95 * up - 0.70 * frame.forward).normalized().cast<float>();
    return light;
}

namespace {
const Colour face_colour = linear_colour({112, 132, 148}), edge_colour = linear_colour({70, 84, 96});
}

GlassLayer glass_face(float cosine) {
    const float away = 1.0f - std::min(1.0f, std::abs(cosine)), square = away * away;
    return {face_colour, 0.045f + 0.42f * square * square * away};
}

GlassLayer glass_edge() {
    return {edge_colour, 0.55f};
}

}  // namespace pelletlab::report::detail
