// Rays in packets of sixteen against the opaque or the glass part of a prepared scene. Embree does the work behind this header.
#pragma once

#include <memory>

#include "report/detail/prepared_scene.hpp"

namespace pelletlab::report::detail {

inline constexpr std::size_t packet_size = 16;

template <class T>
using Lanes = std::array<T, packet_size>;

struct RayPacket {
    std::array<Lanes<float>, 3> origin{}, direction{};  ///< [axis][ray], scaled frame
    Lanes<float> nearest{}, farthest{};                 ///< range of the parameter t in which hits count
    Lanes<bool> active{};

    void set(std::size_t lane, const Vec3f& from, const Vec3f& along, float t_near, float t_far);
    Vec3f at(std::size_t lane, float t) const;
    Vec3f along(std::size_t lane) const { return {direction[0][lane], direction[1][lane], direction[2][lane]}; }
};

enum class Part : std::uint8_t { triangles, spheres, edges };

/// What one ray met first.
struct Hit {
    bool found = false;
    float t = 0.0f;
    std::uint32_t instance = 0;  ///< index into PreparedScene::opaque or ::glass
    Part part = Part::triangles;
    std::uint32_t primitive = 0;
    float u = 0.0f, v = 0.0f;       ///< weights of the triangle's corners 1 and 2
    Vec3f normal = Vec3f::UnitZ();  ///< of the true geometry, scaled frame, unit length
};

enum class Layer { opaque, glass };

class Tracer {
public:
    /// Keeps a reference to `scene`.
    explicit Tracer(const PreparedScene& scene);
    ~Tracer();
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;

    bool has_glass() const;
    void first_hits(Layer layer, const RayPacket& rays, Lanes<Hit>& hits) const;
    /// blocked[i]: ray i meets something opaque. Glass lets light through.
    void blocked(const RayPacket& rays, Lanes<bool>& blocked) const;

private:
    struct Scenes;
    std::unique_ptr<Scenes> scenes_;
};

}  // namespace pelletlab::report::detail
