#include "packing/insertion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <tuple>

#include "core/error.hpp"
#include "core/random.hpp"
#include "packing/detail/lattice.hpp"

namespace pelletlab::packing {

namespace {

constexpr int sweeps = 300;         // the layers of the lattice are gone after 300 at a bounding-sphere packing of 0.48, not after 100
constexpr double elbow_room = 1.2;  // sites of the closest lattice a pellet: with less the cloud stays a crystal
constexpr double apart = 1e-6;      // gap between bounding spheres, of their diameter

std::string millimetres(double length) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g mm", 1e3 * length);
    return text;
}

detail::CentreRegion centre_region(const RigidTemplate& pellet, const InsertionRegion& region) {
    const double radius = pellet.bounding_radius * (1.0 + apart);
    if (!(pellet.bounding_radius > 0.0)) throw bad_input("the pellet '" + pellet.name + "' has no spheres", "make its clump again with: pelletlab shape");
    const double length = region.upper - region.lower;
    if (!(region.radius > 0.0) || !(length > 0.0) || !std::isfinite(region.radius + length)) throw bad_input("the space for the pellets has no size");
    if (radius > region.radius || 2.0 * radius > length || region.ceiling + region.radius < 2.0 * radius)
        throw bad_input("pellet larger than its tube or drum: the pellet needs a sphere of " + millimetres(2.0 * radius) + " and the space for it is " +
                            millimetres(2.0 * region.radius) + " wide and " + millimetres(length) + " long",
                        "check the units of the pellet's mesh and of the case, or use a larger tube or drum");
    return {region.radius - radius, region.ceiling - radius, length - 2.0 * radius};
}

/// From (u, v, w), w along the axis, to the world.
Vec3 to_world(const Vec3& centre, const InsertionRegion& region, double radius) {
    const double along = region.lower + radius + centre.z();
    return region.axis == InsertionRegion::Axis::z ? Vec3(centre.x(), centre.y(), along) : Vec3(centre.x(), along, centre.y());
}

}  // namespace

std::uint32_t cloud_capacity(const RigidTemplate& pellet, const InsertionRegion& region) {
    return static_cast<std::uint32_t>(detail::densest_lattice(centre_region(pellet, region), 2.0 * pellet.bounding_radius * (1.0 + apart)).size());
}

InsertionRegion upright_region(const RigidTemplate& pellet, std::uint32_t count, double packing_fraction, double radius, double lower) {
    const double section = std::numbers::pi * radius * radius;
    InsertionRegion region{InsertionRegion::Axis::z, radius, lower, lower};
    double height = count * pellet.mass_properties.volume / (packing_fraction * section) + 2.0 * pellet.bounding_radius;
    for (region.upper = lower + height; cloud_capacity(pellet, region) < elbow_room * count; region.upper = lower + height) height *= 1.05;
    return region;
}

std::vector<solver::BodyPlacement> loose_cloud(const RigidTemplate& pellet, std::uint32_t count, const InsertionRegion& region, std::uint64_t seed,
                                               const Vec3& velocity) {
    const detail::CentreRegion centres_in = centre_region(pellet, region);
    const double radius = pellet.bounding_radius * (1.0 + apart);
    std::vector<Vec3> centres = detail::scattered_centres(centres_in, 2.0 * radius, count, seed, sweeps);
    if (centres.size() < count)
        throw bad_input("more pellets than fit: " + std::to_string(count) + " were asked for, " + std::to_string(centres.size()) +
                            " can be placed without touching in a space " + millimetres(2.0 * region.radius) + " wide and " +
                            millimetres(region.upper - region.lower) + " long",
                        "lower pellet.count, or make the tube or drum larger");
    for (Vec3& centre : centres) centre = to_world(centre, region, radius);
    std::sort(centres.begin(), centres.end(), [](const Vec3& a, const Vec3& b) { return std::tie(a.z(), a.x(), a.y()) < std::tie(b.z(), b.x(), b.y()); });
    std::vector<solver::BodyPlacement> bodies(count);
    for (std::uint32_t i = 0; i < count; ++i) bodies[i] = {0, {centres[i], RandomStream(seed, i).rotation()}, velocity, Vec3::Zero()};
    return bodies;
}

}  // namespace pelletlab::packing
