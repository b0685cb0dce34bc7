// Trajectories whose measured values are known by construction.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "core/random.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::synthetic {

inline constexpr double pi = std::numbers::pi;

/// A single-sphere pellet.
inline PelletShape sphere_pellet(double radius) {
    PelletShape shape;
    shape.rigid.name = "sphere";
    shape.rigid.spheres = {{Vec3::Zero(), radius}};
    shape.rigid.bounding_radius = radius;
    MassProperties& mass = shape.rigid.mass_properties;
    mass.volume = 4.0 / 3.0 * pi * radius * radius * radius;
    mass.density = 1800.0;
    mass.mass = mass.density * mass.volume;
    mass.principal_inertia = Vec3::Constant(0.4 * mass.mass * radius * radius);
    return shape;
}

/// A box-shaped pellet given by its surface alone: two equal moments about z, half extents (a, a, c).
inline PelletShape box_pellet(double a, double c) {
    PelletShape shape;
    shape.rigid.name = "box";
    for (int corner = 0; corner < 8; ++corner) shape.surface_body.vertices.emplace_back(corner & 1 ? a : -a, corner & 2 ? a : -a, corner & 4 ? c : -c);
    shape.surface_body.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    shape.rigid.bounding_radius = std::sqrt(2.0 * a * a + c * c);
    MassProperties& mass = shape.rigid.mass_properties;
    mass.volume = 8.0 * a * a * c;
    mass.density = 1800.0;
    mass.mass = mass.density * mass.volume;
    mass.principal_inertia = mass.mass / 3.0 * Vec3(a * a + c * c, a * a + c * c, 2.0 * a * a);
    return shape;
}

inline void add_body(Frame& frame, const Vec3& position, const Quat& orientation = Quat::Identity(), const Vec3& velocity = Vec3::Zero(),
                     const Vec3& spin = Vec3::Zero()) {
    frame.positions.push_back(position);
    frame.orientations.push_back(orientation);
    frame.velocities.push_back(velocity);
    frame.spins.push_back(spin);
}

inline Trajectory trajectory_of(const PelletShape& shape, std::vector<Frame> frames) {
    Trajectory trajectory;
    trajectory.head.case_name = "synthetic";
    trajectory.head.shapes = {shape};
    trajectory.head.shape_of_body.assign(frames.front().positions.size(), 0);
    trajectory.frames = std::move(frames);
    return trajectory;
}

/// A drum bed: bodies at uniform random places of the region of the end view where below(x, z) is true, inside the drum, fresh places in every frame: an
/// ideal gas of that mean density, whose time average has a sharp surface. velocity(x, z) gives (vx, vz); spin is the drum's.
struct DrumBed {
    double radius = 0.040, length = 0.020, packing_fraction = 0.6, pellet_radius = 0.00175, spin = 0.0;
    std::function<bool(double, double)> below;
    std::function<Vec3(double, double)> velocity = [](double, double) { return Vec3(Vec3::Zero()); };
};

inline Trajectory drum_trajectory(const DrumBed& bed, std::size_t frame_count, double interval, std::uint64_t seed) {
    const PelletShape shape = sphere_pellet(bed.pellet_radius);
    const auto area = [&] {
        std::size_t inside = 0;
        constexpr int side = 1000;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const double x = ((i + 0.5) / side * 2.0 - 1.0) * bed.radius, z = ((j + 0.5) / side * 2.0 - 1.0) * bed.radius;
                if (x * x + z * z < bed.radius * bed.radius && bed.below(x, z)) ++inside;
            }
        return 4.0 * bed.radius * bed.radius * static_cast<double>(inside) / (side * side);
    }();
    const auto count = static_cast<std::size_t>(bed.packing_fraction * area * bed.length / shape.rigid.mass_properties.volume);
    std::vector<Frame> frames(frame_count);
    for (std::size_t k = 0; k < frame_count; ++k) {
        frames[k].time = interval * static_cast<double>(k);
        RandomStream random(seed, k);
        while (frames[k].positions.size() < count) {
            const double x = random.uniform(-bed.radius, bed.radius), z = random.uniform(-bed.radius, bed.radius);
            if (x * x + z * z > bed.radius * bed.radius || !bed.below(x, z)) continue;
            add_body(frames[k], {x, random.uniform(-0.5, 0.5) * bed.length, z}, random.rotation(), bed.velocity(x, z), {0.0, bed.spin, 0.0});
        }
    }
    return trajectory_of(shape, std::move(frames));
}

}  // namespace pelletlab::synthetic
