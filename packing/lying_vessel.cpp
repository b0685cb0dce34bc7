#include "packing/lying_vessel.hpp"

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "observables/lying_bed.hpp"

namespace pelletlab::packing {

namespace {

constexpr double elbow_room = 1.2;  // sites of the closest lattice a pellet: with less the cloud stays a crystal

/// The user's own vessel: it must be where the measurement expects it.
TriangleMesh read_vessel_mesh(const Case& c, const LyingVessel& vessel) {
    const std::string file = (std::filesystem::path(c.folder) / vessel.mesh_file).string();
    TriangleMesh mesh = meshes::read_mesh(file, vessel.mesh_unit);
    const Box box = bounding_box(mesh);
    // A mesh of the solid vessel has an outer surface as well, so it may be larger than the inside; twice as large is a wrong unit.
    const Vec3 half(0.5 * vessel.diameter, 0.5 * vessel.length, 0.5 * vessel.diameter);
    const Vec3 reach_up = box.max().cwiseQuotient(half), reach_down = (-box.min()).cwiseQuotient(half);
    if (std::min(reach_up.minCoeff(), reach_down.minCoeff()) < 0.95 || std::max(reach_up.maxCoeff(), reach_down.maxCoeff()) > 2.0)
        throw bad_input("the " + vessel.rig + " mesh does not enclose a cylinder of its diameter and length about the y axis, centred in the origin",
                        "move the mesh there, or correct the diameter, the length or the mesh_unit of [" + vessel.rig + "]", {file});
    return mesh;
}

}  // namespace

InsertionRegion lens_region(const RigidTemplate& pellet, std::uint32_t count, double packing_fraction, double diameter, double length) {
    InsertionRegion region{InsertionRegion::Axis::y, 0.5 * diameter, -0.5 * length, 0.5 * length};
    const double wanted = count * pellet.mass_properties.volume / (packing_fraction * length);
    double below = -region.radius, above = region.radius;
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (below + above);
        (observables::segment_area(region.radius, middle) < wanted ? below : above) = middle;
    }
    region.ceiling = above + 2.0 * pellet.bounding_radius;
    while (region.ceiling < region.radius && cloud_capacity(pellet, region) < elbow_room * count) region.ceiling += 0.5 * pellet.bounding_radius;
    region.ceiling = std::min(region.ceiling, region.radius);
    return region;
}

std::vector<solver::WallDefinition> lying_walls(const Case& c, const LyingVessel& vessel) {
    if (!vessel.mesh_file.empty()) return {define_wall(c, "shell", read_vessel_mesh(c, vessel), vessel.material)};
    const double end = 0.5 * vessel.length;
    return {define_wall(c, "shell", meshes::make_drum_shell(vessel.diameter, vessel.length, vessel.facets), vessel.material),
            define_wall(c, "front", meshes::make_drum_end(vessel.diameter, -end, true, vessel.facets), vessel.material),
            define_wall(c, "back", meshes::make_drum_end(vessel.diameter, end, false, vessel.facets), vessel.material)};
}

}  // namespace pelletlab::packing
