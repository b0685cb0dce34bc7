// Spectra of contact events as observables: rates per pellet, with the scatter from turn to turn.
#include <array>
#include <cmath>

#include "experiments/attrition_tester.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::experiments {

namespace {

using solver::ContactEvents;

constexpr double microjoule = 1e-6, milliwatt = 1e-3;

double error_of(const std::vector<double>& values) {
    if (values.size() < 2) return not_known;
    const double mean = observables::mean_of(values), n = static_cast<double>(values.size());
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / (n - 1.0) / n);
}

/// What grew in each turn.
template <class Quantity>
std::vector<double> growth(const std::vector<ContactEvents>& records, const Quantity& quantity) {
    std::vector<double> grown;
    for (std::size_t k = 1; k < records.size(); ++k) grown.push_back(quantity(records[k]) - quantity(records[k - 1]));
    return grown;
}

double sum_of(const std::array<double, solver::spectrum_bins>& bins) {
    double sum = 0.0;
    for (const double value : bins) sum += value;
    return sum;
}

}  // namespace

void add_collisions(Observables& observables, const std::string& kind, const std::vector<ContactEvents>& after_turns, double turn_time, std::size_t pellets,
                    const TimeWindow& window) {
    if (after_turns.size() < 2) return;
    const auto scaled = [](std::vector<double> values, double factor) {
        for (double& value : values) value *= factor;
        return values;
    };
    const auto add = [&](const std::string& name, const char* unit, const std::vector<double>& of_turns, const char* method) {
        observables.values.push_back({name + "_" + kind, unit, pelletlab::observables::mean_of(of_turns), error_of(of_turns), window, method});
    };
    const double per_pellet = 1.0 / (turn_time * static_cast<double>(pellets));
    const std::vector<double> events = growth(after_turns, [](const ContactEvents& e) { return e.complete; });
    add("collision_rate", "1/s", scaled(events, per_pellet), "tester.collisions");
    add("dissipated_power", "mW", scaled(growth(after_turns, [](const ContactEvents& e) { return e.dissipated; }), 1.0 / (turn_time * milliwatt)),
        "tester.collisions");
    constexpr std::array<const char*, solver::event_energies> names{"impact_energy", "normal_dissipation", "total_dissipation"};
    for (std::size_t k = 0; k < names.size(); ++k) {
        std::vector<double> mean = growth(after_turns, [k](const ContactEvents& e) { return sum_of(e.spectra[k].energy); });
        for (std::size_t turn = 0; turn < mean.size(); ++turn) mean[turn] = events[turn] > 0.0 ? mean[turn] / (events[turn] * microjoule) : not_known;
        add(std::string("mean_") + names[k], "uJ", mean, "tester.collisions");
    }
    const ContactEvents &first = after_turns.front(), &last = after_turns.back();
    const double all = last.dissipated - first.dissipated;
    observables.values.push_back({"dissipated_in_collisions_" + kind, "1", all > 0.0 ? (last.dissipated_complete - first.dissipated_complete) / all : not_known,
                                  not_known, window, "tester.collisions"});

    for (std::size_t k = 0; k < names.size(); ++k) {
        Profile profile{std::string("spectrum_") + names[k] + "_" + kind, "1/s", "energy", "uJ", {}, {}, {}, window, "tester.spectrum"};
        std::size_t begin = 0, end = solver::spectrum_bins;
        while (begin < end && last.spectra[k].count[begin] == first.spectra[k].count[begin]) ++begin;
        while (end > begin && last.spectra[k].count[end - 1] == first.spectra[k].count[end - 1]) --end;
        for (std::size_t bin = begin; bin < end; ++bin) {
            const std::vector<double> rate = scaled(growth(after_turns, [&](const ContactEvents& e) { return e.spectra[k].count[bin]; }), per_pellet);
            profile.axis.push_back(std::sqrt(solver::spectrum_edge(bin) * solver::spectrum_edge(bin + 1)) / microjoule);
            profile.value.push_back(pelletlab::observables::mean_of(rate));
            profile.standard_error.push_back(error_of(rate));
        }
        observables.profiles.push_back(std::move(profile));
    }
}

}  // namespace pelletlab::experiments
