#include "shapegen/hand_made.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"

namespace pelletlab::shapegen {

namespace {

constexpr double pellet_radius = 1.56e-3;       // [m]
constexpr double pellet_half_height = 1.48e-3;  // [m]
constexpr double big = 0.765e-3;                // [m], radii of table 2
constexpr double small = 0.35e-3;               // [m]

// `count` spheres of that radius in a ring that touches the lateral surface; `phase` in steps of the ring.
void add_ring(std::vector<Sphere>& spheres, int count, double radius, double z, double phase) {
    const double ring_radius = pellet_radius - radius;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + phase) / count;
        spheres.push_back({{ring_radius * std::cos(angle), ring_radius * std::sin(angle), z}, radius});
    }
}

// `rings` rings of big spheres, evenly spaced; the outer ones touch the end faces.
void add_big_rings(std::vector<Sphere>& spheres, int rings, int count) {
    const double top = pellet_half_height - big;
    for (int k = 0; k < rings; ++k) add_ring(spheres, count, big, -top + 2.0 * top * k / (rings - 1), 0.0);
}

// One ring of small spheres at each end; they touch the end face and the lateral surface.
void add_rim_rings(std::vector<Sphere>& spheres, int count, double phase) {
    const double top = pellet_half_height - small;
    add_ring(spheres, count, small, -top, phase);
    add_ring(spheres, count, small, top, phase);
}

}  // namespace

std::vector<Sphere> hand_made_shape(int number) {
    std::vector<Sphere> spheres;
    switch (number) {
        case 1:  // 12 big
            add_big_rings(spheres, 2, 6);
            break;
        case 2:  // 24 big
            add_big_rings(spheres, 3, 8);
            break;
        case 3:  // 24 big + 18 small
            add_big_rings(spheres, 3, 8);
            add_rim_rings(spheres, 9, 0.5);
            break;
        case 4: {  // 48 big + 34 small: two rings of 16 and the middle of each end face
            add_big_rings(spheres, 3, 16);
            add_rim_rings(spheres, 16, 0.0);
            const double top = pellet_half_height - small;
            spheres.push_back({{0.0, 0.0, -top}, small});
            spheres.push_back({{0.0, 0.0, top}, small});
            break;
        }
        default:
            throw usage_error("there is no hand-made shape " + std::to_string(number), "choose 1, 2, 3 or 4 (12, 24, 42 or 82 spheres)");
    }
    return spheres;
}

}  // namespace pelletlab::shapegen
