#include "packing/compare_beds.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "packing/voidage_correlations.hpp"

namespace pelletlab::packing {
namespace {

using inference::Agreement;

SimulatedBed bed(const char* shape, double height, std::uint64_t seed) {
    return {"run", shape, 24, 1000, 4.073e-5, 2.263e-8, 0.052, height, seed, true};
}

MeasuredFill measured(double height, double deviation, int n) {
    return {1000, 0.0, height, deviation, n, 2};
}

TEST(CompareBeds, CloseBedsAgreeFarOnesDiffer) {
    const std::vector<SimulatedBed> beds{bed("fine", 0.0201, 1),  bed("fine", 0.0200, 2),  bed("fine", 0.0202, 3),
                                         bed("rough", 0.0181, 1), bed("rough", 0.0182, 2), bed("rough", 0.0180, 3)};
    const BedReport report = compare_beds(beds, {measured(0.02, 1e-4, 3)}, {0.02, 0.05});
    ASSERT_EQ(report.against_measurement.size(), 2u);
    EXPECT_EQ(report.against_measurement[0].first, "fine");
    EXPECT_EQ(report.against_measurement[0].agreement, Agreement::equivalent);
    EXPECT_EQ(report.against_measurement[1].agreement, Agreement::differs);
    EXPECT_NE(report.against_measurement[1].words.find("9.5 % lower"), std::string::npos) << report.against_measurement[1].words;
    ASSERT_EQ(report.between_shapes.size(), 1u);
    EXPECT_EQ(report.between_shapes[0].agreement, Agreement::differs);
}

/// A fill known by its mass alone is found by the simulated pellets' mass; one that states both is checked first.
TEST(CompareBeds, MassFindsTheFillAndIsChecked) {
    const std::vector<SimulatedBed> beds{bed("fine", 0.0201, 1), bed("fine", 0.0200, 2)};
    EXPECT_EQ(compare_beds(beds, {{0.0, 0.04073, 0.02, 1e-4, 3, 2}}).against_measurement.size(), 1u);
    // The study's own figures: 200 g are 5212 pellets of 38.37 mg, a cylinder of 3.12 × 2.96 mm at 1800 kg/m³ weighs 40.73 mg.
    SimulatedBed study = bed("fine", 0.09, 1), again = bed("fine", 0.091, 2);
    study.pellets = again.pellets = 5212;
    const BedReport report = compare_beds({study, again}, {{5212, 0.200, 0.09, 1e-3, 3, 2}});
    ASSERT_EQ(report.mass_checks.size(), 1u);
    EXPECT_NEAR(1e6 * report.mass_checks[0].measured, 38.37, 0.005);
    EXPECT_NEAR(report.mass_checks[0].deviation(), -0.058, 0.001);
}

TEST(CompareBeds, WhatIsNoRepeatIsRefused) {
    EXPECT_THROW(compare_beds({bed("fine", 0.02, 1), bed("fine", 0.02, 1)}, {measured(0.02, 1e-4, 3)}), Error);
    SimulatedBed wide = bed("fine", 0.02, 2);
    wide.tube_diameter = 0.06;
    EXPECT_THROW(compare_beds({bed("fine", 0.02, 1), wide}, {measured(0.02, 1e-4, 3)}), Error);
    EXPECT_THROW(compare_beds({bed("fine", 0.02, 1)}, {}), Error);
    EXPECT_THROW(compare_beds({}, {measured(0.02, 1e-4, 3)}), Error);
}

TEST(CompareBeds, ARestlessBedIsLeftOutAndTold) {
    SimulatedBed restless = bed("fine", 0.05, 3);
    restless.at_rest = false;
    const BedReport report = compare_beds({bed("fine", 0.0201, 1), bed("fine", 0.0200, 2), restless}, {measured(0.02, 1e-4, 3)});
    EXPECT_EQ(report.against_measurement[0].first_height.count, 2);
    ASSERT_EQ(report.left_out.size(), 1u);
    EXPECT_NE(report.left_out[0].find("rest"), std::string::npos);
}

TEST(VoidageCorrelations, PublishedFormsAtTheStudysTube) {
    const auto& laws = voidage_correlations_of_cylinders();
    const double s = 3.5093 / 52.0;  // diameter of equal volume of the 3.12 × 2.96 mm cylinder
    EXPECT_NEAR(laws[0].voidage(s), 0.36 + 0.1 * s + 0.7 * s * s, 1e-15);
    EXPECT_NEAR(laws[0].voidage(0.5), 0.585, 1e-12);
    EXPECT_NEAR(laws[1].voidage(0.1), 0.373 + 1.703 / (10.611 * 10.611), 1e-12);
    // 7818 pellets of 22.63 mm³ at voidage 0.37 in 52 mm: 176.9 cm³ / (21.24 cm² · 0.63).
    EXPECT_NEAR(bed_height_at_voidage(0.37, 7818, 2.26304e-8, 0.052), 0.13224, 1e-4);
}

}  // namespace
}  // namespace pelletlab::packing
