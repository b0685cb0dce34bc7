// Charts of measured values: the points are those of the profiles, and nothing is drawn where nothing was measured.
#include "report/measured_charts.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

using namespace pelletlab;
using namespace pelletlab::report;

namespace {

Profile profile(const std::string& name, std::vector<double> axis, std::vector<double> value) {
    Profile p;
    p.name = name;
    p.axis = std::move(axis);
    p.value = std::move(value);
    p.standard_error.assign(p.axis.size(), not_known);
    return p;
}

}  // namespace

TEST(MeasuredCharts, PorosityCountsFromTheWallInDiameters) {
    Observables bed;
    EXPECT_FALSE(porosity_from_wall(bed, 10e-3, {}));
    bed.profiles.push_back(profile("packing_fraction_radial", {1.0, 5.0, 9.0}, {0.5, not_known, 0.2}));
    EXPECT_FALSE(porosity_from_wall(bed, 10e-3, {})) << "without a diameter there is no axis";
    bed.values.push_back({"mean_equivalent_diameter", "mm", 2.0, not_known, {}, ""});
    bed.values.push_back({"packing_fraction_core_clipped", "1", 0.45, not_known, {}, ""});
    const auto chart = porosity_from_wall(bed, 10e-3, {{"somebody 1988", 0.4}});
    ASSERT_TRUE(chart);
    ASSERT_EQ(chart->series.size(), 3u);
    const ChartSeries& porosity = chart->series.back();
    ASSERT_EQ(porosity.points.size(), 2u) << "what is not known is left out";
    EXPECT_NEAR(porosity.points[0].x, 0.5, 1e-12);  // 1 mm from the wall
    EXPECT_NEAR(porosity.points[0].y, 0.8, 1e-12);
    EXPECT_NEAR(porosity.points[1].x, 4.5, 1e-12);
    EXPECT_NEAR(porosity.points[1].y, 0.5, 1e-12);
    EXPECT_NEAR(chart->series[0].points[0].y, 0.4, 1e-12);
    EXPECT_NEAR(chart->series[1].points[0].y, 0.55, 1e-12);
    EXPECT_EQ(picture_of_chart(*chart, {}).width, 1200u);
}

TEST(MeasuredCharts, SpectrumHasALineAKind) {
    Observables tester;
    EXPECT_FALSE(collision_spectrum(tester, "impact_energy"));
    tester.profiles.push_back(profile("spectrum_impact_energy_pellets", {1e-9, 1e-8, 1e-7}, {0.0, 2.0, 1.0}));
    tester.profiles.push_back(profile("spectrum_impact_energy_wall", {1e-9, 1e-8}, {0.0, 0.0}));
    tester.profiles.push_back(profile("spectrum_impact_energy_baffle", {1e-6}, {0.5}));
    for (Profile& spectrum : tester.profiles) spectrum.axis_unit = "uJ";
    const auto chart = collision_spectrum(tester, "impact_energy");
    ASSERT_TRUE(chart);
    ASSERT_EQ(chart->series.size(), 2u) << "no event of a kind, no line";
    EXPECT_EQ(chart->series[0].points.size(), 2u) << "empty bins are not on a logarithmic axis";
    EXPECT_EQ(chart->series[1].name, "pellet - baffle");
    EXPECT_EQ(chart->horizontal.label, "impact energy (µJ)") << "the unit is the profile's";
    EXPECT_EQ(picture_of_chart(*chart, {}).width, 1200u);
    EXPECT_FALSE(collision_spectrum(tester, "total_dissipation"));
}

TEST(MeasuredCharts, OrientationAndForces) {
    Observables bed;
    EXPECT_FALSE(orientation_over_radius(bed));
    EXPECT_FALSE(contact_forces(bed));
    EXPECT_FALSE(porosity_over_height(bed));
    bed.profiles = {profile("axis_alignment_radial", {1.0, 2.0}, {0.5, 0.6}), profile("axis_radial_radial", {1.0, 2.0}, {0.4, 0.3}),
                    profile("contact_force_distribution", {0.125, 0.375}, {2.0, 0.0}), profile("packing_fraction_axial", {1.0}, {0.6})};
    EXPECT_FALSE(orientation_over_radius(bed)) << "rings without an error have too few pellets";
    for (std::size_t k : {0u, 1u}) bed.profiles[k].standard_error = {not_known, 0.02};
    const auto orientation = orientation_over_radius(bed);
    ASSERT_TRUE(orientation);
    ASSERT_EQ(orientation->series[1].points.size(), 1u);
    EXPECT_NEAR(orientation->series[1].errors[0], 0.02, 1e-12);
    const auto forces = contact_forces(bed);
    ASSERT_TRUE(forces);
    EXPECT_EQ(forces->series.back().points.size(), 1u);
    EXPECT_NEAR(porosity_over_height(bed)->series[0].points[0].y, 0.4, 1e-12);
}

TEST(MeasuredCharts, ErrorBarsAreOneAPointOnALinearAxis) {
    Chart chart{"", {"x", false}, {"y", false}, {}};
    ChartSeries series;
    series.points = {{0.0, 1.0}, {1.0, 2.0}};
    series.errors = {0.5};
    chart.series = {series};
    EXPECT_THROW(picture_of_chart(chart, {}), Error);
    chart.series[0].errors = {0.5, 0.5};
    EXPECT_NO_THROW(picture_of_chart(chart, {}));
    chart.vertical.logarithmic = true;
    EXPECT_THROW(picture_of_chart(chart, {}), Error);
}
