#include "observables/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/observables.hpp"
#include "core/random.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;

TEST(Percentile, InterpolatesBetweenNeighbours) {
    EXPECT_DOUBLE_EQ(percentile({4.0, 1.0, 3.0, 2.0, 5.0}, 0.5), 3.0);
    EXPECT_DOUBLE_EQ(percentile({0.0, 10.0}, 0.95), 9.5);
    EXPECT_DOUBLE_EQ(percentile({7.0}, 0.95), 7.0);
    EXPECT_THROW(percentile({}, 0.5), Error);
}

TEST(FitLine, ReturnsTheExactLineAndSkipsMissingPoints) {
    const std::vector<double> x{0.0, 1.0, 2.0, 3.0}, y{1.0, 3.0, not_known, 7.0};
    const LineFit fit = fit_line(x, y);
    EXPECT_EQ(fit.points, 3u);
    EXPECT_NEAR(fit.slope, 2.0, 1e-12);
    EXPECT_NEAR(fit.intercept, 1.0, 1e-12);
    EXPECT_TRUE(std::isnan(fit_line(std::vector<double>{1.0, 1.0}, std::vector<double>{0.0, 2.0}).slope)) << "all x equal";
}

namespace {

/// Series x_k = φ x_{k−1} + ε of unit variance: the error of its mean is √((1 + φ)/((1 − φ) n)) for n ≫ 1/(1 − φ).
double mean_ratio_to_truth(double phi, std::size_t n) {
    double sum = 0.0;
    constexpr int repeats = 400;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        RandomStream random(7, static_cast<std::uint64_t>(repeat));
        std::vector<double> series(n);
        double x = random.normal();
        for (double& value : series) {
            x = phi * x + std::sqrt(1.0 - phi * phi) * random.normal();
            value = x;
        }
        sum += standard_error(series) / std::sqrt((1.0 + phi) / ((1.0 - phi) * static_cast<double>(n)));
    }
    return sum / repeats;
}

}  // namespace

TEST(StandardError, IsOnTheSafeSideOfTheTruthForUncorrelatedValues) {
    const double ratio = mean_ratio_to_truth(0.0, 20);
    EXPECT_GT(ratio, 1.0);
    EXPECT_LT(ratio, 1.3);
}

TEST(StandardError, SeesCorrelationThatTheNaiveErrorMisses) {
    // The naive error would be √((1 − φ)/(1 + φ)) = 0.33 of the truth here. The series is only 20 correlation times long,
    // and its coarsest five blocks of 20 values are still a little correlated: one tenth below is expected, a quarter is not.
    const double ratio = mean_ratio_to_truth(0.8, 100);
    EXPECT_GT(ratio, 0.75);
    EXPECT_LT(ratio, 1.2);
}

TEST(StandardError, NeedsFiveValues) {
    EXPECT_TRUE(std::isnan(standard_error(std::vector<double>{1.0, 2.0, 3.0, 4.0})));
    EXPECT_TRUE(std::isnan(standard_error(std::vector<double>{1.0, 2.0, 3.0, 4.0, not_known})));
    EXPECT_TRUE(std::isfinite(standard_error(std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0})));
}
