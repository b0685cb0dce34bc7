// Calibration on a linear model whose posterior is known: first with a valley, then with the measurement that closes it.
#include "diagnosis/calibrate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "campaign/design.hpp"
#include "core/random.hpp"

namespace pelletlab::diagnosis {
namespace {

/// Two parameters a, b in [0, 1]; «sum» = 10 (a + b) and «difference» = 10 (a − b), nearly without scatter.
Campaign linear_campaign() {
    CampaignTable t;
    t.name = t.file = t.table_file = "made up";
    t.parameters = {{"a", "a", "1", 0.0, 1.0, false}, {"b", "b", "1", 0.0, 1.0, false}};
    t.observables = {{"sum", "mm", "", "", {}, {"sum"}, 0.4}, {"difference", "mm", "", "", {}, {"difference"}, 0.4}};
    RandomStream random(3, 7);
    for (int i = 0; i < 60; ++i) {
        const Eigen::VectorXd u = campaign::sobol_point(i, 2);
        CampaignTable::Row row;
        row.line = i + 2;
        row.parameters = {u[0], u[1]};
        row.outputs = {10 * (u[0] + u[1]) + 0.01 * random.normal(), 10 * (u[0] - u[1]) + 0.01 * random.normal()};
        t.rows.push_back(row);
    }
    return campaign::assemble(t);
}

Measurement measured(const char* name, double value, double uncertainty) {
    Measurement m;
    m.name = m.observable = name;
    m.unit = "mm";
    m.instrument = name;
    m.value = {value};
    m.uncertainty = {uncertainty};
    m.data_sha256 = name;
    return m;
}

Calibration calibrated(const std::vector<Measurement>& measurements) {
    Experiment e;
    e.name = e.file = "test";
    e.measurements = measurements;
    const Problem problem = make_problem(make_model(linear_campaign(), {}, {}, "test"), e, FewData::allow);
    return calibrate(Attributor(problem));
}

TEST(Calibrate, OneNumberLeavesAValley) {
    // The truth 0.3, 0.5: sum 8. Only a + b is known.
    const Calibration c = calibrated({measured("sum", 8.0, 0.1)});
    ASSERT_EQ(c.open.size(), 1u);
    EXPECT_TRUE(c.open[0].text == "0.7 a − 0.7 b" || c.open[0].text == "0.7 b − 0.7 a") << c.open[0].text;
    EXPECT_LT(c.correlation(0, 1), -0.98);
    // a is uniform on (0, 0.8) but for noise: mean 0.4, 90 % interval 0.04 to 0.76.
    EXPECT_NEAR(c.parameters[0].mean, 0.4, 0.04);
    EXPECT_NEAR(c.parameters[0].lower, 0.04, 0.04);
    EXPECT_NEAR(c.parameters[0].upper, 0.76, 0.04);
    // The profile is flat along the valley and steep beyond its end.
    const auto& p = c.parameters[0];
    for (std::size_t k = 0; k < p.profile_value.size(); ++k) {
        if (p.profile_value[k] > 0.1 && p.profile_value[k] < 0.7) {
            EXPECT_LT(p.profile_chi2[k], 0.3) << p.profile_value[k];
        }
        if (p.profile_value[k] > 0.95) {
            EXPECT_GT(p.profile_chi2[k], 4.0) << p.profile_value[k];
        }
    }
    // What would close it is the difference.
    EXPECT_EQ(c.next[0].observable, "difference");
    EXPECT_GT(c.next[0].information, 1.5);
    for (const Eigen::VectorXd& d : c.draws) EXPECT_NEAR(d[0] + d[1], 0.8, 0.15);
}

TEST(Calibrate, TheOtherNumberClosesIt) {
    const Calibration c = calibrated({measured("sum", 8.0, 0.1), measured("difference", -2.0, 0.1)});
    EXPECT_TRUE(c.open.empty());
    for (int i = 0; i < 2; ++i) {
        const auto& p = c.parameters[static_cast<std::size_t>(i)];
        EXPECT_NEAR(p.mean, i == 0 ? 0.3 : 0.5, 0.005);
        // Linear Gaussian: var(sum) = 0.1² + (0.4/2)² each, a = (sum + difference)/20: deviation √2 · √0.05 / 20 = 0.0158; 90 % interval ± 1.645 of it.
        EXPECT_NEAR(p.upper - p.lower, 2 * 1.645 * 0.0158, 0.25 * 2 * 1.645 * 0.0158);
    }
    EXPECT_GT(c.adequacy_p, 0.2);
}

TEST(Calibrate, WhatNoParametersCanDoIsSaid) {
    const Calibration c = calibrated({measured("sum", 8.0, 0.1), measured("difference", -16.0, 0.1)});  // a − b = −1.6 lies outside the square
    EXPECT_LT(c.adequacy_p, 0.02);
}

}  // namespace
}  // namespace pelletlab::diagnosis
