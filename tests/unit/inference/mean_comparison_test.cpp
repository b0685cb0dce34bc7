#include "inference/mean_comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/random.hpp"

namespace pelletlab::inference {
namespace {

TEST(MeanComparison, StudentHasItsClosedForms) {
    for (const double t : {-3.0, -0.4, 0.0, 1.7}) {
        EXPECT_NEAR(student_cdf(t, 1), 0.5 + std::atan(t) / M_PI, 1e-13);             // one degree: Cauchy
        EXPECT_NEAR(student_cdf(t, 2), 0.5 + t / (2 * std::sqrt(2 + t * t)), 1e-13);  // two degrees
    }
    EXPECT_NEAR(student_quantile(0.975, 4), 2.7764451051977987, 1e-10);  // tables
    EXPECT_NEAR(student_quantile(0.95, 2.5), -student_quantile(0.05, 2.5), 1e-10);
}

TEST(MeanComparison, WelchByHand) {
    // 10, 12, 14 and 9, 10, 11, 12, 13: means 12 and 11, variances 4 and 2.5; error² = 4/3 + 0.5; degrees = (11/6)² / ((4/3)²/2 + 0.25/4).
    const MeanDifference d = mean_difference(repeats_of({10, 12, 14}), repeats_of({9, 10, 11, 12, 13}));
    EXPECT_NEAR(d.value, 1.0, 1e-14);
    EXPECT_NEAR(d.standard_error, std::sqrt(11.0 / 6.0), 1e-14);
    EXPECT_NEAR(d.degrees, (121.0 / 36.0) / (8.0 / 9.0 + 1.0 / 16.0), 1e-12);
    EXPECT_NEAR(d.p, 2 * student_cdf(-1.0 / std::sqrt(11.0 / 6.0), d.degrees), 1e-14);
    EXPECT_NEAR(d.upper - d.value, d.value - d.lower, 1e-12);
    EXPECT_FALSE(d.pooled);
}

TEST(MeanComparison, OneValueBorrowsTheOthersScatter) {
    const MeanDifference d = mean_difference(repeats_of({5.0}), repeats_of({4.0, 5.0, 6.0}));
    EXPECT_TRUE(d.pooled);
    EXPECT_NEAR(d.standard_error, std::sqrt(1.0 + 1.0 / 3.0), 1e-14);
    EXPECT_NEAR(d.degrees, 2.0, 0.0);
    EXPECT_THROW(mean_difference(repeats_of({5.0}), repeats_of({4.0})), Error);
}

/// Equivalence and the 90 % interval inside the margin are the same thing.
TEST(MeanComparison, EquivalenceIsAnIntervalInsideTheMargin) {
    const MeanDifference d = mean_difference({20.1, 0.1, 6}, {20.0, 0.12, 3});
    for (const double margin : {0.05, 0.15, 0.2, 0.25, 0.3, 0.5}) {
        const Equivalence e = test_equivalence(d, margin);
        EXPECT_EQ(e.equivalent, e.lower > -margin && e.upper < margin) << margin;
    }
    EXPECT_TRUE(test_equivalence(d, 0.5).equivalent);
    EXPECT_FALSE(test_equivalence(d, 0.05).equivalent);
}

TEST(MeanComparison, FewNoisyRepeatsSayNothing) {
    const Repeats a{20.5, 0.8, 3}, b{20.0, 0.8, 3};
    const MeanDifference d = mean_difference(a, b);
    EXPECT_EQ(agreement_of(d, test_equivalence(d, 0.4)), Agreement::undecided);
    EXPECT_GT(repeats_needed(d, a, b, 0.4), 100);  // the difference lies 0.1 beyond the margin, the scatter is 0.8
    EXPECT_EQ(repeats_needed(d, a, b, 0.5), 0);    // on the edge
}

/// Errors of both kinds over many draws: means at the margin are called equivalent in at most 5 %, equal means called different in about 5 %.
TEST(MeanComparison, ErrorRatesAreTheStatedOnes) {
    RandomStream random(5, 1);
    int wrong_equal = 0, wrong_different = 0;
    constexpr int draws = 4000;
    for (int i = 0; i < draws; ++i) {
        std::vector<double> a, b, c;
        for (int k = 0; k < 5; ++k) {
            a.push_back(random.normal());
            b.push_back(4.0 + 1.5 * random.normal());
            c.push_back(random.normal());
        }
        const MeanDifference apart = mean_difference(repeats_of(a), repeats_of(b));
        wrong_equal += test_equivalence(apart, 4.0).equivalent ? 1 : 0;
        wrong_different += mean_difference(repeats_of(a), repeats_of(c)).p < 0.05 ? 1 : 0;
    }
    EXPECT_NEAR(wrong_equal / double(draws), 0.05, 0.012);      // 3.5 standard errors of 4000 draws
    EXPECT_NEAR(wrong_different / double(draws), 0.05, 0.016);  // Welch is a little conservative at n = 5
}

}  // namespace
}  // namespace pelletlab::inference
