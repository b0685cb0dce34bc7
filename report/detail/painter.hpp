// What one pixel sees and how it is lit, kept apart in a record so that noise of the light can be smoothed without touching edges and colours.
#pragma once

#include <span>

#include "report/detail/camera_rays.hpp"
#include "report/detail/lighting.hpp"
#include "report/detail/sampling.hpp"
#include "report/detail/tracer.hpp"

namespace pelletlab::report::detail {

using Light = Eigen::Array3f;  ///< linear red, green, blue

/// colour = veil + through · (key_seen · key + sky_seen · open_sky + (1 − sky_seen) · blocked_sky), each the mean over the pixel.
struct PixelRecord {
    static constexpr std::uint32_t mixed = 0xffffffffu;  ///< several things in one pixel: never smoothed
    static constexpr std::uint32_t ground = 0xfffffffeu;
    static constexpr std::uint32_t nothing = 0xfffffffdu;

    std::uint32_t thing = nothing;  ///< the opaque instance that fills the pixel, or one of the above
    Vec3f normal = Vec3f::Zero();
    Light key = Light::Zero(), open_sky = Light::Zero(), blocked_sky = Light::Zero();
    float key_seen = 1.0f, sky_seen = 1.0f;  ///< unblocked shares of the rays sent to the key light and to the sky
    Light veil = Light::Zero();              ///< light from glass in front
    float through = 1.0f;                    ///< share that glass lets through

    bool smooth() const { return thing != mixed && thing != nothing; }
    Light colour(float key_share, float sky_share) const {
        return veil + through * (key_share * key + sky_share * open_sky + (1.0f - sky_share) * blocked_sky);
    }
};

/// What one camera ray sees.
struct Sight {
    std::uint32_t thing = PixelRecord::nothing;
    float t = 0.0f;
    Vec3f view = Vec3f::UnitY(), point = Vec3f::Zero();
    Vec3f true_normal = Vec3f::UnitZ(), normal = Vec3f::UnitZ();  ///< both towards the eye; `normal` is the smooth one
    Light surface = Light::Ones();
    Light key = Light::Zero(), open_sky = Light::Zero(), blocked_sky = Light::Zero();
    float key_seen = 1.0f, sky_seen = 1.0f;
    Light veil = Light::Zero();
    float through = 1.0f;
};

/// A pixel that one smooth thing fills: what its middle sees tells its colour, and its few rays to the lights are shared out among neighbours.
struct PlainPixel {
    std::uint32_t x = 0, y = 0;
    Sight* seen = nullptr;
    PixelRecord* record = nullptr;
};

struct Ground {
    bool drawn = false;
    float level = 0.0f;  ///< scaled
};

class Painter {
public:
    Painter(const Scene& scene, const PreparedScene& prepared, const Tracer& tracer, const CameraRays& camera, const Lighting& light, std::uint32_t width,
            std::uint32_t samples);
    /// A pixel of any kind, with all samples.
    PixelRecord pixel(std::uint32_t x, std::uint32_t y) const;

    /// What the middles of `seen.size()` ≤ packet_size neighbours in a row see, from pixel (x, y) on.
    void glance(std::uint32_t x, std::uint32_t y, std::span<Sight> seen) const;
    /// Fills the records of pixels on things (or all on the ground), `each` rays a pixel to the key light and to the sky: at most packet_size / (2 each)
    /// pixels. Neighbours within squares of `side` pixels share an even set.
    void light_plain(std::span<const PlainPixel> pixels, std::size_t each, std::uint32_t side) const;
    bool has_glass() const { return tracer_.has_glass(); }
    Light background() const { return background_; }

private:
    struct Packet;
    void aim(RayPacket& rays, std::size_t lane, double x, double y) const;
    Packet look(std::uint32_t x, std::uint32_t y, const PixelSamples& pattern, std::size_t first) const;
    Sight sight(const RayPacket& rays, std::size_t lane, const Hit& hit) const;
    void read_surface(const Hit& hit, Sight& seen) const;
    void shade(Sight& seen) const;
    void light_every_ray(Packet& packet, const PixelSamples& pattern, std::size_t first) const;
    std::size_t light_some_rays(Packet& packet, const PixelSamples& pattern, std::size_t first) const;
    void add_glass(Packet& packet) const;
    PixelRecord whole_pixel(Packet& packet, const PixelSamples& pattern, std::size_t first) const;
    Light mixed_pixel(Packet& packet, const PixelSamples& pattern, std::size_t first) const;

    const PreparedScene& prepared_;
    const Tracer& tracer_;
    const CameraRays& camera_;
    Lighting light_;
    Light background_;
    Ground ground_;
    std::uint32_t width_, samples_;
};

}  // namespace pelletlab::report::detail
