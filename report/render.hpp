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
    Vec3 eye = {0.0, -1.0, 0.0};  ///< [m]
    Vec3 target = Vec3::Zero();   ///< [m]
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
    std::vector<Vec3> vertex_normals;    ///< unit, own frame, one a vertex of `mesh`, of its true surface; empty: from the faces
    bool glass = false;                  ///< walls: drawn as a thin transparent shell with its edges as lines
    double crease_angle = 0.6;           ///< [rad], faces that meet flatter than this are shaded as one smooth surface
};

struct Scene {
    std::vector<SceneObject> objects;
    Colour background = {1.0f, 1.0f, 1.0f};
    bool ground = false;        ///< soft shadows on an invisible floor z = ground_level
    double ground_level = 0.0;  ///< [m]
};

/// The picture: key light from upper left behind the camera, light sky with ambient occlusion, samples_per_pixel rays over the pixel's square.
/// The bytes depend on the arguments alone, not on the number of threads. Throws Error(bad_input) for a size or sample count of zero, a scene with nothing
/// to draw, wrong counts of colours, values that are not finite, and a camera that looks nowhere.
Image render(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t samples_per_pixel = 16);

/// PNG with 8-bit sRGB, written to «file.part» and renamed; throws Error(bad_input) with the file's name when that fails.
void write_png(const Image& image, const std::filesystem::path& file);

}  // namespace pelletlab::report
