// Small bodies and scenes that the tests of this room share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "core/random.hpp"
#include "report/pictures.hpp"

namespace pelletlab::report::testing {

/// Axis-aligned closed box with outward normals.
inline TriangleMesh box(const Vec3& lower, const Vec3& upper) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(), i & 4 ? upper.z() : lower.z());
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Closed cylinder, axis z, centre in the origin.
inline TriangleMesh cylinder(double diameter, double height, std::uint32_t facets) {
    TriangleMesh mesh;
    mesh.vertices = {{0.0, 0.0, -0.5 * height}, {0.0, 0.0, 0.5 * height}};
    for (std::uint32_t i = 0; i < facets; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / facets, x = 0.5 * diameter * std::cos(angle), y = 0.5 * diameter * std::sin(angle);
        mesh.vertices.emplace_back(x, y, -0.5 * height);
        mesh.vertices.emplace_back(x, y, 0.5 * height);
    }
    for (std::uint32_t i = 0; i < facets; ++i) {
        const std::uint32_t a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % facets);
        mesh.faces.insert(mesh.faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}, {0, b, a}, {1, a + 1, b + 1}});
    }
    return mesh;
}

/// The side of a cylinder alone, from z = lower to upper.
inline TriangleMesh tube(double diameter, double lower, double upper, std::uint32_t facets) {
    TriangleMesh mesh = cylinder(diameter, 1.0, facets);
    std::erase_if(mesh.faces, [](const Triangle& face) { return face[0] < 2; });
    for (Vec3& vertex : mesh.vertices) vertex.z() = vertex.z() < 0.0 ? lower : upper;
    return mesh;
}

inline TriangleMesh disc(double diameter, double level, std::uint32_t facets) {
    TriangleMesh mesh = cylinder(diameter, 1.0, facets);
    std::erase_if(mesh.faces, [](const Triangle& face) { return face[0] != 1; });
    for (Vec3& vertex : mesh.vertices) vertex.z() = level;
    return mesh;
}

/// z becomes y: for the drum's walls.
inline TriangleMesh laid_down(TriangleMesh mesh) {
    for (Vec3& vertex : mesh.vertices) vertex = Vec3(vertex.x(), vertex.z(), -vertex.y());
    return mesh;
}

inline PelletShape small_pellet() {
    PelletShape shape;
    shape.rigid.name = "pellet";
    shape.rigid.spheres = {{{0.0, 0.0, -0.0007}, 0.0012}, {{0.0, 0.0, 0.0007}, 0.0012}};
    shape.surface_body = cylinder(0.00312, 0.00296, 24);
    return shape;
}

inline void add_pellets(TrajectoryHeader& header, Frame& frame, std::size_t count, const Box& where, std::uint64_t seed) {
    RandomStream random(seed, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = random.uniform(where.min().x(), where.max().x()), y = random.uniform(where.min().y(), where.max().y());
        frame.positions.emplace_back(x, y, random.uniform(where.min().z(), where.max().z()));
        frame.orientations.push_back(random.rotation());
        frame.velocities.emplace_back(random.normal() * 0.1, 0.0, random.normal() * 0.1);
        frame.spins.push_back(Vec3::Zero());
        header.shape_of_body.push_back(0);
    }
    frame.wall_poses.resize(header.walls.size());
}

struct Bed {
    TrajectoryHeader header;
    Frame frame;
};

inline Bed bed_in_tube(std::size_t count = 60) {
    Bed bed;
    bed.header.case_name = "tube";
    bed.header.shapes = {small_pellet()};
    bed.header.walls = {{"shell", tube(0.030, 0.0, 0.060, 48)}, {"floor", disc(0.030, 0.0, 48)}};
    add_pellets(bed.header, bed.frame, count, Box(Vec3(-0.009, -0.009, 0.002), Vec3(0.009, 0.009, 0.012)), 7);
    return bed;
}

inline Bed bed_in_drum(std::size_t count = 60) {
    Bed bed;
    bed.header.case_name = "drum";
    bed.header.shapes = {small_pellet()};
    bed.header.walls = {
        {"shell", laid_down(tube(0.040, -0.010, 0.010, 48))}, {"back", laid_down(disc(0.040, 0.010, 48))}, {"front", laid_down(disc(0.040, -0.010, 48))}};
    add_pellets(bed.header, bed.frame, count, Box(Vec3(-0.012, -0.008, -0.014), Vec3(0.008, 0.008, -0.006)), 8);
    return bed;
}

inline Camera parallel_camera(double height, const Vec3& forward = Vec3::UnitY()) {
    return {-20.0 * forward, Vec3::Zero(), Vec3::UnitZ(), 0.0, height};
}

inline std::size_t pixels_unlike(const Image& image, const std::array<std::uint8_t, 3>& colour) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) count += image.rgb[i] != colour[0] || image.rgb[i + 1] != colour[1] || image.rgb[i + 2] != colour[2];
    return count;
}

inline std::array<std::uint8_t, 3> pixel(const Image& image, std::size_t x, std::size_t y) {
    const std::size_t at = 3 * (y * image.width + x);
    return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// A folder of this test alone, removed at its end.
class Folder {
public:
    Folder() {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::path(::testing::TempDir()) / (std::string("pelletlab_report_") + info->test_suite_name() + "_" + info->name());
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace pelletlab::report::testing
