// A campaign by formula, whose truth is known: two parameters, three effects with patterns of their own, a profile in two regimes.
#pragma once

#include <cmath>
#include <memory>

#include "campaign/assemble.hpp"
#include "core/random.hpp"
#include "diagnosis/problem.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::diagnosis::made_up {

inline const std::vector<double> axis{-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6};
inline constexpr double noise = 0.1;

/// Effects: 0 bends the profile, 1 makes a bump, 2 is a bump beside it that effect 1 can nearly imitate.
inline double height(double x, double speed, const Eigen::Vector2d& phi, const Eigen::Vector3d& theta) {
    return (2.0 + 3.0 * phi[0]) * x + phi[1] * speed + 4.0 * theta[0] * x * x * (1.3 - speed) + 2.5 * theta[1] * std::exp(-std::pow((x - 0.2) / 0.2, 2)) +
           2.5 * theta[2] * std::exp(-std::pow((x - 0.22) / 0.2, 2));
}

inline CampaignTable table(std::uint64_t seed = 1) {
    CampaignTable t;
    t.name = "made up";
    t.file = "made-up.toml";
    t.regime_name = "speed";
    t.regime_unit = "rpm";
    t.parameters = {{"a", "a", "1", 0.0, 1.0, false}, {"b", "b", "1", 0.0, 1.0, false}};
    for (const char* name : {"bend", "bump", "twin"}) t.effects.push_back({name, name, name, "1", 0.0, 1.0, false, false, "contact"});
    CampaignObservable o{"surface", "mm", "x", "1", axis, {}, 0.2};
    for (std::size_t i = 0; i < axis.size(); ++i) o.columns.push_back("z" + std::to_string(i));
    t.observables = {o};
    RandomStream random(seed, 77);
    const auto run = [&](int i, int effect, double amplitude) {
        const Eigen::VectorXd u = inference::halton(static_cast<std::uint64_t>(i) + 1, 2);
        Eigen::Vector3d theta = Eigen::Vector3d::Zero();
        if (effect >= 0) theta[effect] = amplitude;
        for (const double rpm : {20.0, 50.0}) {
            CampaignTable::Row row{i, "", rpm, false, {u[0], u[1]}, {theta[0], theta[1], theta[2]}, {}};
            for (const double x : axis) row.outputs.push_back(height(x, rpm / 50.0, u, theta) + noise * random.normal());
            t.rows.push_back(row);
        }
    };
    for (int i = 0; i < 24; ++i) run(i, -1, 0.0);
    for (int e = 0; e < 3; ++e)
        for (int i = 0; i < 12; ++i) run(100 + 12 * e + i, e, 0.08 * (i + 1));
    return t;
}

/// A reality at (φ, θ), with `extra(x, speed)` that no effect of the library makes.
template <class Extra>
Experiment reality(std::uint64_t seed, const Eigen::Vector2d& phi, const Eigen::Vector3d& theta, const Extra& extra) {
    Experiment e;
    e.name = "made up";
    e.file = "made-up-experiment.toml";
    e.settings.bootstrap = 150;
    RandomStream random(seed, 4711);
    for (const double rpm : {20.0, 50.0}) {
        Measurement m;
        m.observable = "surface";
        m.regime = rpm == 20.0 ? "20 rpm" : "50 rpm";
        m.name = m.regime;
        m.unit = "mm";
        m.axis_unit = "1";
        m.instrument = m.regime;
        m.axis = axis;
        for (const double x : axis) {
            m.value.push_back(height(x, rpm / 50.0, phi, theta) + extra(x, rpm / 50.0) + noise * random.normal());
            m.uncertainty.push_back(noise);
        }
        e.measurements.push_back(m);
    }
    return e;
}

inline Experiment reality(std::uint64_t seed, const Eigen::Vector2d& phi, const Eigen::Vector3d& theta) {
    return reality(seed, phi, theta, [](double, double) { return 0.0; });
}

}  // namespace pelletlab::diagnosis::made_up
