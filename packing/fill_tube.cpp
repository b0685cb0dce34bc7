#include "packing/fill_tube.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "observables/bed.hpp"
#include "packing/insertion.hpp"
#include "packing/run_figures.hpp"
#include "packing/stage.hpp"

namespace pelletlab::packing {

namespace {

/// Where the loose pellets go. A tube of given height is filled up to insertion.packing_fraction or to its rim; one as high as needed is made higher.
InsertionRegion cloud_region(const Case& c, const RigidTemplate& pellet) {
    const double radius = 0.5 * c.tube.diameter;
    if (!(c.tube.height > 0.0)) return upright_region(pellet, c.pellet.count, c.insertion.packing_fraction, radius, 0.0);
    const double section = std::numbers::pi * radius * radius;
    const double wanted = c.pellet.count * pellet.mass_properties.volume / (c.insertion.packing_fraction * section) + 2.0 * pellet.bounding_radius;
    InsertionRegion region{InsertionRegion::Axis::z, radius, 0.0, std::min(wanted, c.tube.height)};
    if (cloud_capacity(pellet, region) < c.pellet.count) region.upper = c.tube.height;
    return region;
}

/// The user's own tube: it must be where the measurement expects it.
TriangleMesh read_tube_mesh(const Case& c, double cloud_top) {
    const std::string file = (std::filesystem::path(c.folder) / c.tube.mesh_file).string();
    TriangleMesh mesh = meshes::read_mesh(file, c.tube.mesh_unit);
    const Box box = bounding_box(mesh);
    // A mesh of the solid vessel has an outer surface as well, so it may be wider than the bore; twice as wide is a wrong unit.
    const double radius = 0.5 * c.tube.diameter, slack = 0.05 * c.tube.diameter;
    const double narrowest = std::min(box.max().head<2>().minCoeff(), -box.min().head<2>().maxCoeff());
    const double widest = std::max(box.max().head<2>().maxCoeff(), -box.min().head<2>().minCoeff());
    const bool fits = narrowest > radius - slack && widest < 2.0 * radius && box.min().z() < slack && box.min().z() > -c.tube.diameter;
    if (!fits)
        throw bad_input("the tube mesh does not enclose a circle of tube.diameter about the z axis with its floor at z = 0",
                        "move the mesh there, or correct tube.diameter or tube.mesh_unit", {file});
    if (box.max().z() < cloud_top)
        throw bad_input(
            "the tube mesh is " + std::to_string(1e3 * box.max().z()) + " mm high and the loose pellets need " + std::to_string(1e3 * cloud_top) + " mm",
            "use a higher tube, fewer pellets, or a larger insertion.packing_fraction", {file});
    return mesh;
}

std::vector<solver::WallDefinition> tube_walls(const Case& c, double cloud_top) {
    const TubeRig& tube = c.tube;
    std::vector<solver::WallDefinition> walls;
    if (!tube.mesh_file.empty()) {
        walls.push_back(define_wall(c, "shell", read_tube_mesh(c, cloud_top), tube.material));
        return walls;
    }
    const double height = tube.height > 0.0 ? tube.height : cloud_top;
    walls.push_back(define_wall(c, "shell", meshes::make_tube_shell(tube.diameter, 0.0, height, tube.facets), tube.material));
    walls.push_back(define_wall(c, "floor", meshes::make_disc(0.5 * tube.diameter, 0.0, true, tube.facets), tube.material));
    return walls;
}

Vec3 falling(const Case& c) {
    const double g = c.gravity.norm();
    return g > 0.0 ? Vec3(c.gravity * (c.insertion.fall_speed / g)) : Vec3(0.0, 0.0, -c.insertion.fall_speed);
}

}  // namespace

RunResult fill_tube(const Case& c, const RunInputs& inputs, const std::function<FrameSink(const TrajectoryHeader&)>& open_sink, const ProgressSink& progress,
                    const RunKeeping& keeping) {
    if (c.rig != Rig::tube) throw bad_input("the case '" + c.name + "' is not a tube", "set rig = \"tube\"");
    if (c.pellet.count == 0) throw bad_input("pellet.count is 0: a tube needs a number of pellets", "set pellet.count");
    solver::SimulationDefinition definition = define_simulation(c, inputs, {});
    const InsertionRegion region = cloud_region(c, definition.templates.front());
    definition.walls = tube_walls(c, region.upper);
    solver::Simulation simulation(std::move(definition));
    if (!keeping.from) simulation.add_bodies(loose_cloud(simulation.definition().templates.front(), c.pellet.count, region, c.seed, falling(c)));

    Trajectory last;  // the bed is measured from one frame
    FrameSink stored;
    Course course(
        simulation,
        [&](const Frame& frame) {
            if (stored) stored(frame);
        },
        progress, keeping);
    last.head = trajectory_header(c, inputs, simulation);
    if (open_sink) stored = open_sink(last.head);
    if (!course.is_catching_up()) course.store(capture_frame(simulation));
    const SettleStatus status = settle(course, simulation, c, c.output.frame_interval);
    last.frames = {capture_frame(simulation)};
    const RunMeter& meter = course.meter;

    RunResult result;
    result.observables = observables::measure_tube_bed(last, {0.5 * c.tube.diameter, 0.0, c.measurement.height_grid});
    if (status == SettleStatus::not_at_rest) result.observables.status = "not at rest";  // says more than «thin bed»
    if (const double share = load_share(simulation, "floor"); std::isfinite(share))
        result.observables.values.push_back({"floor_load_share", "1", share, not_known, {simulation.time(), simulation.time()}, "tube.floor_load"});
    add_contact_figures(result.observables, simulation, meter);
    result.state_hash = simulation.state_hash();
    result.steps = meter.steps;
    result.wall_seconds = meter.wall_seconds;
    result.pellet_steps_per_second = meter.pellet_steps_per_second(simulation.bodies().size());
    return result;
}

}  // namespace pelletlab::packing
