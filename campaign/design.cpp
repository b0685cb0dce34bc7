#include "campaign/design.hpp"

#include <fmt/format.h>

#include <boost/random/sobol.hpp>
#include <cmath>

#include "campaign/assemble.hpp"

namespace pelletlab::campaign {

Eigen::VectorXd sobol_point(int i, int dimensions) {
    boost::random::sobol engine(static_cast<std::size_t>(dimensions));
    engine.discard((static_cast<std::uint64_t>(i) + 1) * static_cast<std::uint64_t>(dimensions));  // the sequence begins with the corner 0
    Eigen::VectorXd point(dimensions);
    for (int j = 0; j < dimensions; ++j) point[j] = static_cast<double>(engine() >> 11) * 0x1p-53;
    return point;
}

namespace {

std::vector<double> values_at(const CampaignPlan& plan, const Eigen::VectorXd& phi) {
    std::vector<double> values;
    for (std::size_t j = 0; j < plan.parameters.size(); ++j) values.push_back(value_of_coordinate(plan.parameters[j], phi[static_cast<Eigen::Index>(j)]));
    return values;
}

std::vector<double> baseline_of(const CampaignPlan& plan) {
    std::vector<double> baseline;
    for (const CampaignEffect& e : plan.effects) baseline.push_back(e.baseline);
    return baseline;
}

/// Value of the i-th run of an effect, u uniform in (0, 1).
double amplitude_at(const CampaignPlan& plan, std::size_t effect, int i, double u) {
    const auto& levels = plan.effect_levels[effect];
    if (!levels.empty()) return levels[static_cast<std::size_t>(i) % levels.size()];
    const double theta = 0.15 + 0.85 * u;
    return value_of_amplitude(plan.effects[effect], plan.effects[effect].two_sided && i % 2 == 1 ? -theta : theta);
}

}  // namespace

int base_points(const CampaignPlan& plan) {
    return plan.points > 0 ? plan.points : 10 * static_cast<int>(plan.parameters.size());
}

std::vector<PlannedRun> design_of(const CampaignPlan& plan) {
    std::vector<PlannedRun> runs;
    const std::vector<double> baseline = baseline_of(plan);
    std::uint64_t number = 0;
    const auto add = [&](const std::vector<double>& parameters, const std::vector<double>& effects) {
        ++number;
        for (std::size_t rig = 0; rig < plan.rigs.size(); ++rig) runs.push_back({static_cast<int>(rig), parameters, effects, 1000000 * plan.seed + number});
    };
    const int dimensions = static_cast<int>(plan.parameters.size()), points = base_points(plan);
    for (int i = 0; i < points; ++i) add(values_at(plan, sobol_point(i, dimensions)), baseline);
    for (int repeat = 1; repeat < plan.repeats; ++repeat)
        for (int i = 0; i < std::min(plan.anchors, points); ++i) add(values_at(plan, sobol_point(i, dimensions)), baseline);
    for (std::size_t k = 0; k < plan.effects.size(); ++k) {
        if (plan.effect_kinds[k] == PlannedEffectKind::library_data) continue;
        for (int i = 0; i < plan.runs_an_effect; ++i) {
            // One more dimension for the amplitude; every effect goes on where the one before ended.
            const Eigen::VectorXd u = sobol_point(points + static_cast<int>(k) * plan.runs_an_effect + i, dimensions + 1);
            auto effects = baseline;
            effects[k] = amplitude_at(plan, k, i, u[dimensions]);
            add(values_at(plan, u.head(dimensions)), effects);
        }
    }
    return runs;
}

std::vector<PlannedReading> readings_of(const CampaignPlan& plan) {
    std::vector<PlannedReading> readings;
    const int points = base_points(plan);
    for (std::size_t k = 0; k < plan.effects.size(); ++k) {
        if (plan.effect_kinds[k] != PlannedEffectKind::library_data) continue;
        for (int i = 0; i < std::min(plan.runs_an_effect, points); ++i) {
            PlannedReading reading{i, baseline_of(plan)};
            reading.effects[k] = amplitude_at(plan, k, i, sobol_point(static_cast<int>(k) * plan.runs_an_effect + i, 1)[0]);
            readings.push_back(reading);
        }
    }
    return readings;
}

std::vector<std::string> overrides_of(const CampaignPlan& plan, const PlannedRun& run) {
    std::vector<std::string> list;
    const auto set = [&list](const std::vector<std::string>& keys, double value, const std::string& unit) {
        for (const std::string& key : keys) list.push_back(fmt::format("{}={:.17g}{}", key, value, unit == "1" ? "" : " " + unit));
    };
    for (std::size_t j = 0; j < plan.parameters.size(); ++j) set(plan.parameter_keys[j], run.parameters[j], plan.parameters[j].unit);
    for (std::size_t k = 0; k < plan.effects.size(); ++k) set(plan.effect_keys[k], run.effects[k], plan.effects[k].unit);
    list.push_back(fmt::format("seed={}", run.seed));
    return list;
}

}  // namespace pelletlab::campaign
