#include "experiments/rotating_drum.hpp"

#include <cmath>
#include <numbers>
#include <span>

#include "core/error.hpp"
#include "experiments/turning_run.hpp"
#include "observables/drum.hpp"
#include "observables/statistics.hpp"
#include "packing/extra_walls.hpp"
#include "packing/insertion.hpp"
#include "packing/lying_vessel.hpp"

namespace pelletlab::experiments {

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t torque_groups = 20;

/// Torque about the axis that keeps the drum turning, against what the pellets exert on the turning walls; positive in the sense of rotation [N m].
double drive_torque(const solver::Simulation& simulation, const Case& c) {
    double torque = 0.0;
    for (std::size_t wall = 0; wall < simulation.definition().walls.size(); ++wall)
        if (packing::turns_with_vessel(c, simulation.definition().walls[wall].name)) torque -= simulation.wall_loads()[wall].torque.y();
    return c.drum.speed < 0.0 ? -torque : torque;
}

/// Mean of the samples, with the error from the means of 20 stretches of time.
Observable mean_torque(const std::vector<double>& samples, const TimeWindow& window) {
    std::vector<double> stretches;
    for (std::size_t g = 0; g < torque_groups; ++g) {
        const std::size_t begin = g * samples.size() / torque_groups, end = (g + 1) * samples.size() / torque_groups;
        stretches.push_back(observables::mean_of(std::span(samples).subspan(begin, end - begin)));
    }
    constexpr double milli = 1e-3;
    return {"drum_torque", "mN*m", observables::mean_of(samples) / milli, observables::standard_error(stretches) / milli, window, "drum.torque"};
}

}  // namespace

std::uint32_t pellet_count(const DrumRig& drum, double pellet_volume) {
    const double drum_volume = pi * 0.25 * drum.diameter * drum.diameter * drum.length;
    const double count = std::round(drum.fill_fraction * drum_volume * drum.bulk_packing_fraction / pellet_volume);
    if (!(count >= 1.0) || count > 1e8)
        throw bad_input("a fill fraction of " + std::to_string(drum.fill_fraction) + " is " + std::to_string(count) + " pellets in this drum",
                        "check the drum's size, drum.fill_fraction and the pellet's unit");
    return static_cast<std::uint32_t>(count);
}

packing::RunResult run_drum(const Case& c, const packing::RunInputs& inputs, const std::function<packing::FrameSink(const TrajectoryHeader&)>& open_sink,
                            const ProgressSink& progress, const packing::RunKeeping& keeping) {
    if (c.rig != Rig::drum) throw bad_input("the case '" + c.name + "' is not a drum", "set rig = \"drum\"");
    std::vector<solver::WallDefinition> walls =
        packing::lying_walls(c, {"drum", c.drum.diameter, c.drum.length, c.drum.facets, c.drum.mesh_file, c.drum.mesh_unit, c.drum.material});
    packing::add_walls_of_case(c, walls);
    solver::Simulation simulation(packing::define_simulation(c, inputs, std::move(walls)));
    const RigidTemplate& pellet = simulation.definition().templates.front();
    const std::uint32_t count = c.pellet.count > 0 ? c.pellet.count : pellet_count(c.drum, pellet.mass_properties.volume);
    if (!keeping.from)
        simulation.add_bodies(packing::loose_cloud(pellet, count,
                                                   packing::lens_region(pellet, count, c.insertion.packing_fraction, c.drum.diameter, c.drum.length), c.seed,
                                                   {0.0, 0.0, -c.insertion.fall_speed}));

    TurningRun run(c, inputs, simulation, open_sink, progress, keeping);
    run.spin_up(c.drum.speed);
    packing::Stage measure;
    measure.duration = c.time.measure;
    measure.watch = [&](const solver::Simulation& now, std::vector<double>& memory) {  // torques, after what TurningRun remembers
        memory.push_back(drive_torque(now, c));
        return false;
    };
    run.measure(measure);

    const TimeWindow window{measure.memory.at(0), measure.memory.at(0) + c.time.measure};
    const std::vector<double> torques(measure.memory.begin() + 2, measure.memory.end());
    Observables observables =
        observables::measure_drum(run.measured(), {0.5 * c.drum.diameter, c.drum.length, c.drum.speed, c.measurement.velocity_grid}, window);
    observables.values.push_back(mean_torque(torques, window));
    return packing::run_result(std::move(observables), simulation, run.course().meter);
}

}  // namespace pelletlab::experiments
