#include "packing/fill_tube.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "observables/bed.hpp"
#include "observables/lying_bed.hpp"
#include "packing/extra_walls.hpp"
#include "packing/fill_ways.hpp"
#include "packing/lying_vessel.hpp"
#include "packing/run_figures.hpp"
#include "packing/stage.hpp"

namespace pelletlab::packing {

namespace {

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

/// A tube that lies: filled with a cloud, measured as it lies.
struct Vessel {
    std::vector<solver::WallDefinition> walls;
    FillPlan plan;
};

Vessel make_vessel(const Case& c, const RigidTemplate& pellet) {
    const TubeRig& tube = c.tube;
    Vessel vessel;
    if (tube.lying) {
        vessel.plan.rounds = {c.pellet.count};
        vessel.plan.region = lens_region(pellet, c.pellet.count, c.insertion.packing_fraction, tube.diameter, tube.height);
        vessel.walls = lying_walls(c, {"tube", tube.diameter, tube.height, tube.facets, tube.mesh_file, tube.mesh_unit, tube.material});
        return vessel;
    }
    vessel.plan = plan_fill(c, pellet);
    vessel.walls = tube_walls(c, vessel.plan.top);
    for (const solver::WallDefinition& wall : vessel.plan.walls) vessel.walls.push_back(wall);
    return vessel;
}

Observables measure(const Trajectory& last, const Case& c) {
    if (c.tube.lying) return observables::measure_lying_bed(last, {0.5 * c.tube.diameter, c.tube.height, c.measurement.height_grid});
    observables::TubeGeometry tube{0.5 * c.tube.diameter, 0.0, c.measurement.height_grid};
    tube.overlaps = false;  // dear beside a short run; `pelletlab observe tube` has them from its trajectory
    return observables::measure_tube_bed(last, tube);
}

}  // namespace

RunResult fill_tube(const Case& c, const RunInputs& inputs, const std::function<FrameSink(const TrajectoryHeader&)>& open_sink, const ProgressSink& progress,
                    const RunKeeping& keeping) {
    if (c.rig != Rig::tube) throw bad_input("the case '" + c.name + "' is not a tube", "set rig = \"tube\"");
    if (c.pellet.count == 0) throw bad_input("pellet.count is 0: a tube needs a number of pellets", "set pellet.count");
    solver::SimulationDefinition definition = define_simulation(c, inputs, {});
    Vessel vessel = make_vessel(c, definition.templates.front());
    const FillPlan& plan = vessel.plan;
    definition.walls = std::move(vessel.walls);
    add_walls_of_case(c, definition.walls);
    solver::Simulation simulation(std::move(definition));
    if (!keeping.from) add_round(simulation, c, plan, 0);

    Trajectory last;  // the bed is measured from one frame
    Course course(simulation, progress, keeping);
    course.pellets_in_all = c.pellet.count;
    last.head = trajectory_header(c, inputs, simulation);
    last.head.shape_of_body.assign(c.pellet.count, 0);
    course.open(open_sink ? open_sink(last.head) : FrameSink(), capture_frame(simulation, c.pellet.count));
    const SettleStatus status = tap(course, simulation, c, fill(course, simulation, c, plan));
    last.frames = {capture_frame(simulation)};

    Observables observables = measure(last, c);
    if (plan.outlet > 0.0 && pellets_above(simulation, plan.outlet) > 0) observables.status = "funnel not empty";
    if (status == SettleStatus::not_at_rest) observables.status = "not at rest";  // says more than «thin bed»
    if (const double share = load_share(simulation, "floor"); std::isfinite(share))
        observables.values.push_back({"floor_load_share", "1", share, not_known, {simulation.time(), simulation.time()}, "tube.floor_load"});
    return run_result(std::move(observables), simulation, course.meter);
}

}  // namespace pelletlab::packing
