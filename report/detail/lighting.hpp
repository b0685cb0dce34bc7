// The studio of every picture: a broad key light, a light sky, and how matte pellets and thin glass answer to them.
#pragma once

#include "report/detail/prepared_scene.hpp"

namespace pelletlab::report::detail {

/// Directions and strengths. Chosen so that a surface facing the camera in full light shows nearly its own colour: then the colour bar can be trusted.
struct Lighting {
    Vec3f up = Vec3f::UnitZ();
    Vec3f to_key = Vec3f::UnitZ();  ///< unit vector towards the key light
    float key_spread = 0.13f;       ///< tangent of half the angle that the light fills: makes shadows soft
    float key_strength = 0.62f;     ///< on a surface square to it
    float sky_strength = 0.70f;     ///< of the sky straight above; the horizon and what lies below are darker
    float sky_below = 0.72f;        ///< sky straight below, relative to above
    float bounce = 0.28f;           ///< light that comes from a direction where something stands, times that surface's colour
    float gloss = 0.05f;            ///< strength of the soft highlight, (n·h)^32
};

/// Key light from upper left, behind the camera.
Lighting studio(const Camera& camera);

/// Light that a surface with that normal gets from the whole open sky: strength · (b + (1 − b)·(1 + d·up)/2) averaged over directions d with weight cos/π,
/// which is d·up → 2/3 n·up.
inline float open_sky(const Lighting& light, const Vec3f& normal) {
    return light.sky_strength * (light.sky_below + (1.0f - light.sky_below) * (0.5f + normal.dot(light.up) / 3.0f));
}

/// Colour and opacity of one glass surface seen at |cos| between ray and normal: nearly clear face on, darker at the rim (Schlick 1994's power of five).
struct GlassLayer {
    Colour colour{};
    float opacity = 0.0f;
};
GlassLayer glass_face(float cosine);
GlassLayer glass_edge();

}  // namespace pelletlab::report::detail
