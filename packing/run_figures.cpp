#include "packing/run_figures.hpp"

#include <utility>

#include "solver/time_step.hpp"

namespace pelletlab::packing {

void add_contact_figures(Observables& observables, const solver::Simulation& simulation, const RunMeter& meter) {
    const solver::ContactSummary contacts = simulation.contacts();
    const double pellets = static_cast<double>(simulation.bodies().size()), now = simulation.time();
    const auto add = [&](const char* name, double value, const TimeWindow& window, const char* method) {
        observables.values.push_back({name, "1", value, not_known, window, method});
    };
    add("largest_overlap_ratio", meter.largest_overlap_ratio, {0.0, now}, "run.largest_overlap");
    const solver::TimeStepAdvice advice = solver::advise_time_step(simulation.definition());
    const double step = simulation.definition().time_step;
    add("time_step_of_limit", step / advice.limit_at(meter.largest_overlap_ratio), {0.0, now}, "run.time_step");
    add("time_step_of_rayleigh", step / advice.rayleigh, {0.0, now}, "run.time_step");
    add("touching_neighbours", 2.0 * static_cast<double>(contacts.touching_pairs) / pellets, {now, now}, "run.contacts");
    add("sphere_contacts_per_pellet", static_cast<double>(contacts.sphere_contacts) / pellets, {now, now}, "run.contacts");
    add("wall_contacts_per_pellet", static_cast<double>(contacts.wall_contacts) / pellets, {now, now}, "run.contacts");
}

std::vector<BookLine> energy_book(const solver::Simulation& simulation) {
    if (!simulation.definition().physics.energy_book) return {};
    const solver::EnergyReport e = simulation.energy();
    std::vector<BookLine> book;
    const auto add = [&](const std::string& name, double joule) { book.push_back({name, 1e3 * joule}); };
    add("energy_kinetic", e.kinetic_translation + e.kinetic_rotation);
    add("energy_gravity", e.gravity);
    add("energy_elastic", e.elastic_normal + e.elastic_tangential + e.elastic_rolling);
    for (std::size_t w = 0; w < e.wall_work.size(); ++w) add("work_of_" + simulation.definition().walls[w].name, e.wall_work[w]);
    add("work_of_body_forces", e.body_force_work);
    add("energy_fed", e.fed);
    add("dissipated_normal_damping", e.normal_damping);
    add("dissipated_tangential_damping", e.tangential_damping);
    add("dissipated_sliding", e.sliding);
    add("dissipated_rolling", e.rolling);
    return book;
}

RunResult run_result(Observables measured, const solver::Simulation& simulation, const RunMeter& meter) {
    add_contact_figures(measured, simulation, meter);
    return {std::move(measured),    simulation.state_hash(), meter.steps, meter.wall_seconds, meter.pellet_steps_per_second(simulation.bodies().size()),
            energy_book(simulation)};
}

double load_share(const solver::Simulation& simulation, const std::string& wall) {
    const solver::SimulationDefinition& definition = simulation.definition();
    double mass = 0.0;
    for (const std::uint32_t index : simulation.bodies().template_index) mass += definition.templates[index].mass_properties.mass;
    const double g = definition.gravity.norm();
    if (!(mass * g > 0.0)) return not_known;
    for (std::size_t k = 0; k < definition.walls.size(); ++k)
        if (definition.walls[k].name == wall) return simulation.wall_loads()[k].force.dot(definition.gravity) / (mass * g * g);
    return not_known;
}

}  // namespace pelletlab::packing
