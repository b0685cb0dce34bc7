// Pictures by Embree's ray tracer: triangles and spheres, perspective or parallel camera, soft light, PNG out.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/observables.hpp"
#include "core/rigid_template.hpp"
#include "core/trajectory.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::report {

using Colour = std::array<float, 3>;  ///< linear red, green, blue in [0, 1]

struct Camera {
    Vec3 eye, target;  ///< [m]
    Vec3 up = {0.0, 0.0, 1.0};
    double field_of_view = 0.6;  ///< [rad], vertical; 0: parallel projection of height `height`
    double height = 0.0;         ///< [m]
};

struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< row by row from the top, 3 bytes a pixel
};

/// One thing to draw: a mesh drawn at many poses with a colour each (instanced), or spheres, or both.
struct SceneObject {
    TriangleMesh mesh;            ///< own frame; may be empty
    std::vector<Sphere> spheres;  ///< own frame; may be empty
    std::vector<Pose> poses;
    std::vector<Colour> colours;         ///< one a pose
    std::vector<Colour> vertex_colours;  ///< one a vertex of `mesh`, replaces `colours` when not empty
    bool glass = false;                  ///< walls: drawn as a thin transparent shell
};

struct Scene {
    std::vector<SceneObject> objects;
    Colour background = {1.0f, 1.0f, 1.0f};
};

Image render(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t samples_per_pixel = 16);
void write_png(const Image& image, const std::filesystem::path& file);

}  // namespace pelletlab::report
