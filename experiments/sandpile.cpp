#include "experiments/sandpile.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "observables/pile.hpp"
#include "packing/extra_walls.hpp"
#include "packing/funnel.hpp"
#include "packing/rest.hpp"
#include "packing/run_figures.hpp"
#include "packing/stage.hpp"
#include "packing/wall_motions.hpp"

namespace pelletlab::experiments {

namespace {

constexpr double outlet_above_plate = 0.100;            // [m], where the case does not say
constexpr double tray_below = 0.050, tray_rim = 0.150;  // [m], of the tray below and beyond the plate
constexpr double watch_interval = 0.001;                // [s]
constexpr double lift_beyond = 0.010;                   // [m] that the cylinder is lifted above the top of the bed that it held
enum Memory : std::size_t { rest_since, rest_pairs, released_at, open_at, last_above, memory_size };

bool pours(const Case& c) {
    return c.pile.release == "funnel";
}

double outlet_height(const Case& c) {
    return c.funnel.outlet_height > 0.0 ? c.funnel.outlet_height : outlet_above_plate;
}

/// z above which a pellet has not left the funnel; the cylinder has no such height.
double ceiling(const Case& c) {
    return pours(c) ? outlet_height(c) : std::numeric_limits<double>::infinity();
}

TriangleMesh read_cylinder_mesh(const Case& c, double top) {
    const std::string file = (std::filesystem::path(c.folder) / c.pile.mesh_file).string();
    TriangleMesh mesh = meshes::read_mesh(file, c.pile.mesh_unit);
    const Box box = bounding_box(mesh);
    const double radius = 0.5 * c.pile.cylinder_diameter;
    const double narrowest = std::min(box.max().head<2>().minCoeff(), -box.min().head<2>().maxCoeff());
    if (std::abs(box.min().z()) > 0.05 * radius || narrowest < 0.95 * radius || narrowest > 2.0 * radius)
        throw bad_input("the mesh is no cylinder of pile.cylinder_diameter about the z axis that stands on z = 0",
                        "move the mesh there, or correct pile.cylinder_diameter or pile.mesh_unit", {file});
    if (box.max().z() < top) mesh = meshes::joined(std::move(mesh), meshes::make_tube_shell(c.pile.cylinder_diameter, box.max().z(), top, c.funnel.facets));
    return mesh;
}

struct Rig {
    std::vector<solver::WallDefinition> walls;
    packing::InsertionRegion region;
};

Rig make_rig(const Case& c, const RigidTemplate& pellet) {
    const PileRig& pile = c.pile;
    Rig rig;
    const double radius = 0.5 * pile.plate_diameter, tray_diameter = pile.plate_diameter + 2.0 * tray_rim;
    rig.walls.push_back(packing::define_wall(c, "plate", meshes::make_disc(radius, 0.0, true, c.funnel.facets), pile.material));
    rig.walls.push_back(packing::define_wall(c, "tray",
                                             meshes::joined(meshes::make_disc(0.5 * tray_diameter, -tray_below, true, c.funnel.facets),
                                                            meshes::make_tube_shell(tray_diameter, -tray_below, tray_below, c.funnel.facets)),
                                             pile.material));
    if (pours(c)) {
        packing::Funnel funnel = packing::make_funnel(c, pellet, pile.material, outlet_height(c));
        rig.region = funnel.region;
        for (solver::WallDefinition& wall : funnel.walls) rig.walls.push_back(std::move(wall));
    } else {
        if (pile.cylinder_diameter >= pile.plate_diameter)
            throw bad_input("the cylinder is wider than the plate that it stands on", "make pile.plate_diameter larger");
        rig.region = packing::upright_region(pellet, c.pellet.count, c.insertion.packing_fraction, 0.5 * pile.cylinder_diameter, 0.0);
        TriangleMesh shell = pile.mesh_file.empty() ? meshes::make_tube_shell(pile.cylinder_diameter, 0.0, rig.region.upper, c.funnel.facets)
                                                    : read_cylinder_mesh(c, rig.region.upper);
        rig.walls.push_back(packing::define_wall(c, "cylinder", std::move(shell), pile.material));
    }
    return rig;
}

/// Begins the release; the time that it takes [s].
double release(solver::Simulation& simulation, const Case& c) {
    if (pours(c)) {
        packing::open_shutter(simulation, c.funnel);
        return c.funnel.shutter_time;
    }
    double top = 0.0;
    for (const Vec3& p : simulation.bodies().position) top = std::max(top, p.z());
    const double lift = top + simulation.definition().templates.front().bounding_radius + lift_beyond, time = lift / c.pile.lift_speed;
    packing::change_motions(
        simulation, [](const std::string& wall) { return wall == "cylinder"; },
        [&](solver::WallMotion& motion) {
            motion.table = {{0.0, Vec3::Zero(), 0.0}, {time, lift * Vec3::UnitZ(), 0.0}};
        });
    return time;
}

/// What the last frame shows, with what only the run knows.
Observables measure(const Trajectory& last, const Case& c, bool at_rest, const std::vector<double>& memory) {
    const Frame& frame = last.frames.front();
    std::size_t above = 0, below = 0;
    for (const Vec3& p : frame.positions) above += p.z() > ceiling(c) ? 1 : 0, below += p.z() < 0.0 ? 1 : 0;
    const TimeWindow instant{frame.time, frame.time};
    Observables result;
    if (above + below < frame.positions.size()) {
        result = observables::measure_pile(last, {0.0, 0.0, 0.0, ceiling(c), c.measurement.height_grid});
        if (!at_rest && result.status == "complete") result.status = "not at rest";
        if (at_rest && above > 0) result.status = "funnel not empty";
    } else {
        result.case_name = c.name;
        result.status = "not discharged";
        result.values = {{"pellets_counted", "1", 0.0, not_known, instant, "pile.pellets"},
                         {"pellets_above", "1", static_cast<double>(above), not_known, instant, "pile.pellets"}};
    }
    result.values.push_back({"pellets_off_plate", "1", static_cast<double>(below), not_known, instant, "pile.pellets"});
    const TimeWindow discharge{memory[released_at], frame.time};
    if (pours(c) && above == 0)
        result.values.push_back({"discharge_time", "s", memory[last_above] - memory[released_at], not_known, discharge, "pile.discharge"});
    if (at_rest) result.values.push_back({"time_to_rest", "s", frame.time - memory[released_at], not_known, discharge, "pile.discharge"});
    return result;
}

}  // namespace

packing::RunResult run_pile(const Case& c, const packing::RunInputs& inputs, const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink,
                            const ProgressSink& progress, const packing::RunKeeping& keeping) {
    if (c.rig != pelletlab::Rig::pile) throw bad_input("the case '" + c.name + "' is not a pile", "set rig = \"pile\"");
    if (c.pellet.count == 0) throw bad_input("pellet.count is 0: a pile needs a number of pellets", "set pellet.count");
    solver::SimulationDefinition definition = packing::define_simulation(c, inputs, {});
    Rig rig = make_rig(c, definition.templates.front());
    definition.walls = std::move(rig.walls);
    packing::add_walls_of_case(c, definition.walls);
    solver::Simulation simulation(std::move(definition));
    if (!keeping.from)
        simulation.add_bodies(
            packing::loose_cloud(simulation.definition().templates.front(), c.pellet.count, rig.region, c.seed, {0.0, 0.0, -c.insertion.fall_speed}));

    Trajectory last;  // the pile is measured from one frame
    packing::Course course(simulation, progress, keeping);
    last.head = packing::trajectory_header(c, inputs, simulation);
    course.open(open_sink ? open_sink(last.head) : packing::FrameSink(), packing::capture_frame(simulation));
    packing::settle(course, simulation, c, c.output.frame_interval, "settling in the " + c.pile.release);

    packing::RestRule rest(c, simulation);
    packing::Stage discharge;
    discharge.name = pours(c) ? "discharging" : "lifting the cylinder";
    discharge.duration = c.pile.discharge_limit;
    discharge.frame_interval = c.output.frame_interval;
    discharge.watch_interval = watch_interval;
    discharge.memory.assign(memory_size, 0.0);
    std::copy(packing::RestRule::start.begin(), packing::RestRule::start.end(), discharge.memory.begin());
    if (!course.is_catching_up()) {
        discharge.memory[released_at] = discharge.memory[last_above] = simulation.time();
        discharge.memory[open_at] = simulation.time() + release(simulation, c);
    }
    discharge.watch = [&](const solver::Simulation& now, std::vector<double>& memory) {
        if (packing::pellets_above(now, ceiling(c)) > 0) memory[last_above] = now.time();
        if (now.time() < memory[open_at]) return false;
        return rest.holds(now, memory.data() + rest_since);
    };
    discharge.note = [&] { return rest.note(); };
    const bool at_rest = course.run(discharge) == packing::StageEnd::watch_ended_it;
    last.frames = {packing::capture_frame(simulation)};

    return packing::run_result(measure(last, c, at_rest, discharge.memory), simulation, course.meter);
}

}  // namespace pelletlab::experiments
