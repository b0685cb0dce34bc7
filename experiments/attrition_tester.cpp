#include "experiments/attrition_tester.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <span>

#include "core/error.hpp"
#include "experiments/turning_run.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "observables/tester.hpp"
#include "packing/extra_walls.hpp"
#include "packing/lying_vessel.hpp"

namespace pelletlab::experiments {

namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;

double turn_time(const Case& c) {
    return full_turn / std::abs(c.tester.speed);
}

double whole_turns(const Case& c) {
    return std::floor(c.time.measure / turn_time(c) + 1e-9);
}

/// Whole turns in time.measure; a measurement shorter than a turn stays as it is, and its status says so.
double measured_time(const Case& c) {
    return whole_turns(c) >= 1.0 ? whole_turns(c) * turn_time(c) : c.time.measure;
}

TriangleMesh baffle_mesh(const Case& c) {
    const TesterRig& t = c.tester;
    // A drum that turns about −y is mirrored: its baffle's angle grows the other way round.
    if (t.baffle_mesh_file.empty())
        return meshes::make_baffle(t.diameter, t.length, t.baffle_height, t.baffle_thickness, t.speed < 0.0 ? -t.baffle_start : t.baffle_start);
    const std::string file = (std::filesystem::path(c.folder) / t.baffle_mesh_file).string();
    TriangleMesh mesh = meshes::read_mesh(file, t.mesh_unit);
    const Box box = bounding_box(mesh);
    const double reach = 1.1 * std::hypot(t.diameter, t.length) / 2.0;
    if (box.min().cwiseAbs().maxCoeff() > reach || box.max().cwiseAbs().maxCoeff() > reach)
        throw bad_input("the baffle mesh reaches out of the tester", "move the mesh there, or correct tester.mesh_unit", {file});
    return mesh;
}

/// Walls and the room for the loose pellets, which the baffle must not reach into.
std::vector<solver::WallDefinition> tester_walls(const Case& c, const packing::InsertionRegion& region) {
    const TesterRig& t = c.tester;
    std::vector<solver::WallDefinition> walls = packing::lying_walls(c, {"tester", t.diameter, t.length, t.facets, t.mesh_file, t.mesh_unit, t.material});
    if (t.baffle_height <= 0.0 && t.baffle_mesh_file.empty()) return walls;
    TriangleMesh baffle = baffle_mesh(c);
    if (bounding_box(baffle).min().z() < region.ceiling)
        throw bad_input("the baffle reaches into the room of the loose pellets",
                        "turn it up with tester.baffle_start (\"180 deg\": at the top), or use fewer pellets");
    walls.push_back(packing::define_wall(c, "baffle", std::move(baffle), t.material));
    return walls;
}

/// ContactEvents are nothing but numbers: a record of all kinds for the memory of the stage.
constexpr std::size_t record_size = sizeof(solver::ContactEvents) / sizeof(double);
using Record = std::array<double, record_size>;

void remember(std::vector<double>& memory, const solver::Simulation& now) {
    for (const solver::ContactEvents& kind : now.contact_events()) {
        const auto record = std::bit_cast<Record>(kind);
        memory.insert(memory.end(), record.begin(), record.end());
    }
}

solver::ContactEvents recall(std::span<const double> memory, std::size_t index) {
    Record record{};
    std::copy_n(memory.begin() + static_cast<std::ptrdiff_t>(index * record_size), record_size, record.begin());
    return std::bit_cast<solver::ContactEvents>(record);
}

void add(solver::ContactEvents& sum, const solver::ContactEvents& part) {
    auto a = std::bit_cast<Record>(sum);
    const auto b = std::bit_cast<Record>(part);
    for (std::size_t k = 0; k < record_size; ++k) a[k] += b[k];
    sum = std::bit_cast<solver::ContactEvents>(a);
}

/// Collisions of pellets with each other, with shell and end plates, and with the baffle; `memory` holds a record of all kinds after each turn.
void add_all_collisions(Observables& observables, std::span<const double> memory, const solver::Simulation& simulation, double turn_time,
                        const TimeWindow& window) {
    const std::vector<solver::WallDefinition>& walls = simulation.definition().walls;
    const std::size_t kinds = 1 + walls.size(), turns = memory.size() / (kinds * record_size), pellets = simulation.bodies().size();
    const auto is_baffle = [](const solver::WallDefinition& wall) { return wall.name == "baffle"; };
    std::vector<solver::ContactEvents> between(1), with_walls(1), with_baffle(1);  // nothing at the beginning
    for (std::size_t turn = 0; turn < turns; ++turn) {
        std::vector<solver::ContactEvents> record(kinds);
        for (std::size_t k = 0; k < kinds; ++k) record[k] = recall(memory, turn * kinds + k);
        between.push_back(record[0]);
        with_walls.emplace_back();
        with_baffle.emplace_back();
        for (std::size_t w = 0; w < walls.size(); ++w) add(is_baffle(walls[w]) ? with_baffle.back() : with_walls.back(), record[1 + w]);
    }
    add_collisions(observables, "pellets", between, turn_time, pellets, window);
    add_collisions(observables, "wall", with_walls, turn_time, pellets, window);
    if (std::any_of(walls.begin(), walls.end(), is_baffle)) add_collisions(observables, "baffle", with_baffle, turn_time, pellets, window);
}

}  // namespace

packing::RunResult run_tester(const Case& c, const packing::RunInputs& inputs, const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink,
                              const ProgressSink& progress, const packing::RunKeeping& keeping) {
    if (c.rig != Rig::tester) throw bad_input("the case '" + c.name + "' is not an attrition tester", "set rig = \"tester\"");
    if (c.pellet.count == 0) throw bad_input("pellet.count is 0: a tester needs a number of pellets", "set pellet.count");
    solver::SimulationDefinition definition = packing::define_simulation(c, inputs, {});
    definition.physics.energy_book = true;
    const RigidTemplate& pellet = definition.templates.front();
    const packing::InsertionRegion region = packing::lens_region(pellet, c.pellet.count, c.insertion.packing_fraction, c.tester.diameter, c.tester.length);
    definition.walls = tester_walls(c, region);
    packing::add_walls_of_case(c, definition.walls);
    solver::Simulation simulation(std::move(definition));
    if (!keeping.from)
        simulation.add_bodies(
            packing::loose_cloud(simulation.definition().templates.front(), c.pellet.count, region, c.seed, {0.0, 0.0, -c.insertion.fall_speed}));

    TurningRun run(c, inputs, simulation, open_sink, progress, keeping);
    run.spin_up(c.tester.speed);
    packing::Stage measure;
    measure.duration = measured_time(c);
    // After what TurningRun remembers: records of the contacts after each turn but the last.
    const auto turns = static_cast<std::size_t>(std::max(1.0, whole_turns(c)));
    const double each = measure.duration / static_cast<double>(turns);
    measure.watch = [&](const solver::Simulation& now, std::vector<double>& memory) {
        const std::size_t taken = (memory.size() - 2) / ((1 + now.definition().walls.size()) * record_size);
        if (taken + 1 < turns && now.time() - memory[0] >= static_cast<double>(taken + 1) * each - 0.5 * c.time.step) remember(memory, now);
        return false;
    };
    if (!run.course().is_catching_up()) simulation.record_contact_events();
    run.measure(measure);
    remember(measure.memory, simulation);

    const TimeWindow window{measure.memory.at(0), measure.memory.at(0) + measure.duration};
    const double spun = static_cast<double>(packing::steps_in(c.time.spin_up, c.time.step)) * c.time.step;
    const double turned = c.time.spin_up > 0.0 ? spun : 0.0;
    Observables observables = observables::measure_tester(run.measured(),
                                                          {0.5 * c.tester.diameter, c.tester.length, c.tester.baffle_height, c.tester.speed,
                                                           c.tester.baffle_start, window.begin - turned, c.measurement.velocity_grid},
                                                          window);
    add_all_collisions(observables, std::span(measure.memory).subspan(2), simulation, each, window);
    return packing::run_result(std::move(observables), simulation, run.course().meter);
}

}  // namespace pelletlab::experiments
