// A clump with nothing round or symmetric in it, so that a swapped axis or a lost digit shows.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "core/clump_template.hpp"
#include "core/random.hpp"
#include "shapegen/formats/formats.hpp"

namespace pelletlab::shapegen::formats {

inline ClumpTemplate test_clump(std::size_t spheres = 7) {
    ClumpTemplate clump;
    RandomStream random(20240917, 1);
    clump.rigid.name = "test pellet-1";
    for (std::size_t i = 0; i < spheres; ++i) {
        Sphere sphere;
        sphere.centre = Vec3(random.uniform(-1.0, 1.0), random.uniform(-0.8, 0.9), random.uniform(-1.1, 1.2)) * 1e-3;
        sphere.radius = random.uniform(0.31, 0.77) * 1e-3;
        clump.rigid.spheres.push_back(sphere);
    }
    MassProperties& mass = clump.rigid.mass_properties;
    mass.volume = 2.2629866e-8;
    mass.density = 1812.5;
    mass.mass = mass.volume * mass.density;
    mass.principal_inertia = Vec3(4.9566e-11, 5.4525e-11, 6.01234567e-11);
    clump.rigid.bounding_radius = bounding_radius(clump.rigid.spheres);
    return clump;
}

/// Two spheres with short numbers, for tests that compare text.
inline ClumpTemplate dumbbell() {
    ClumpTemplate clump;
    clump.rigid.name = "dumbbell";
    clump.rigid.spheres = {{Vec3(-0.0005, 0.0, 0.0), 0.001}, {Vec3(0.0005, 0.00025, 0.0), 0.0015}};
    clump.rigid.mass_properties.volume = 2e-8;
    clump.rigid.mass_properties.density = 2000.0;
    clump.rigid.mass_properties.mass = 4e-5;
    clump.rigid.mass_properties.principal_inertia = Vec3(3e-11, 5e-11, 6e-11);
    clump.rigid.bounding_radius = bounding_radius(clump.rigid.spheres);
    return clump;
}

}  // namespace pelletlab::shapegen::formats
