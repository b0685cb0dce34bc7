// A pellet of two spheres and small cases that run in a second.
#pragma once

#include <numbers>

#include "core/case.hpp"
#include "packing/run_frames.hpp"

namespace pelletlab::small_case {

/// Two touching spheres of 1.5 mm diameter: V = 2 · 4/3 π r³, inertia by the parallel axes.
inline packing::RunInputs dumbbell_inputs() {
    constexpr double r = 0.75e-3, density = 1800.0;
    packing::RunInputs inputs;
    RigidTemplate& pellet = inputs.clump.rigid;
    pellet.name = "dumbbell";
    pellet.spheres = {{Vec3(0.0, 0.0, -r), r}, {Vec3(0.0, 0.0, r), r}};
    pellet.bounding_radius = 2.0 * r;
    MassProperties& mass = pellet.mass_properties;
    mass.volume = 2.0 * 4.0 / 3.0 * std::numbers::pi * r * r * r;
    mass.density = density;
    mass.mass = density * mass.volume;
    const double along = 0.4 * mass.mass * r * r, across = along + mass.mass * r * r;
    mass.principal_inertia = {across, across, along};
    return inputs;
}

inline Case base_case() {
    Case c;
    c.materials = {{"pellet", {1800.0, 2e6, 0.25}}, {"vessel", {1000.0, 2e6, 0.25}}};
    c.contacts = {{"pellet-pellet", {0.4, 0.5, 0.01}}, {"pellet-vessel", {0.4, 0.5, 0.01}}};
    c.time.step = 2e-5;
    c.time.settle_limit = 1.0;
    return c;
}

inline Case tube_case(std::uint32_t count) {
    Case c = base_case();
    c.rig = Rig::tube;
    c.pellet.count = count;
    c.tube.diameter = 0.010;
    c.tube.facets = 24;
    return c;
}

inline Case drum_case(std::uint32_t count) {
    Case c = base_case();
    c.rig = Rig::drum;
    c.pellet.count = count;
    c.drum.diameter = 0.030;
    c.drum.length = 0.010;
    c.drum.facets = 36;
    c.drum.speed = 5.0;
    c.time.settle_limit = 0.15;
    c.time.spin_up = 0.1;
    c.time.measure = 0.2;
    return c;
}

}  // namespace pelletlab::small_case
