#include "packing/funnel.hpp"

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "packing/wall_motions.hpp"

namespace pelletlab::packing {

namespace {

constexpr double shutter_size = 1.1, shutter_way = 1.2;  // in outlet diameters

/// The user's own funnel: its outlet must be where the shutter is.
TriangleMesh read_funnel_mesh(const Case& c, double outlet_height) {
    const std::string file = (std::filesystem::path(c.folder) / c.funnel.mesh_file).string();
    TriangleMesh mesh = meshes::read_mesh(file, c.funnel.mesh_unit);
    const Box box = bounding_box(mesh);
    const double slack = 0.05 * c.funnel.outlet_diameter, radius = 0.5 * c.funnel.top_diameter;
    const double narrowest = std::min(box.max().head<2>().minCoeff(), -box.min().head<2>().maxCoeff());
    if (std::abs(box.min().z() - outlet_height) > slack || narrowest < 0.95 * radius || narrowest > 2.0 * radius)
        throw bad_input("the funnel mesh is not as wide as funnel.top_diameter about the z axis with its outlet at a height of " +
                            std::to_string(1e3 * outlet_height) + " mm",
                        "move the mesh there, or correct funnel.top_diameter, funnel.outlet_height or funnel.mesh_unit", {file});
    return mesh;
}

}  // namespace

Funnel make_funnel(const Case& c, const RigidTemplate& pellet, const std::string& material, double outlet_height) {
    const FunnelRig& f = c.funnel;
    const double radius = 0.5 * f.top_diameter;
    Funnel funnel;
    TriangleMesh mesh;
    if (f.mesh_file.empty()) {
        const double shoulder = outlet_height + meshes::funnel_cone_height(f.outlet_diameter, f.top_diameter, f.half_angle);
        funnel.region = upright_region(pellet, c.pellet.count, c.insertion.packing_fraction, radius, shoulder);
        mesh = meshes::make_funnel(f.outlet_diameter, f.top_diameter, f.half_angle, outlet_height, funnel.region.upper, f.facets);
    } else {
        mesh = read_funnel_mesh(c, outlet_height);
        funnel.region = upright_region(pellet, c.pellet.count, c.insertion.packing_fraction, radius, bounding_box(mesh).max().z());
        mesh = meshes::joined(std::move(mesh), meshes::make_tube_shell(f.top_diameter, funnel.region.lower, funnel.region.upper, f.facets));
    }
    funnel.walls.push_back(define_wall(c, "funnel", std::move(mesh), material));
    funnel.walls.push_back(define_wall(c, "shutter", meshes::make_disc(0.5 * shutter_size * f.outlet_diameter, outlet_height, true, f.facets), material));
    return funnel;
}

void open_shutter(solver::Simulation& simulation, const FunnelRig& funnel) {
    change_motions(
        simulation, [](const std::string& wall) { return wall == "shutter"; },
        [&](solver::WallMotion& motion) {
            motion.table = {{0.0, Vec3::Zero(), 0.0}, {funnel.shutter_time, shutter_way * funnel.outlet_diameter * Vec3::UnitX(), 0.0}};
        });
}

std::size_t pellets_above(const solver::Simulation& simulation, double level) {
    const std::vector<Vec3>& places = simulation.bodies().position;
    return static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [level](const Vec3& p) { return p.z() > level; }));
}

}  // namespace pelletlab::packing
