#include "inference/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "inference/gaussian.hpp"
#include "inference/pod.hpp"

namespace pelletlab::inference {
namespace {

TEST(Statistics, NormalQuantileInvertsTheDistribution) {
    for (const double p : {1e-9, 0.001, 0.02, 0.3, 0.5, 0.975, 1 - 1e-7}) EXPECT_NEAR(normal_cdf(normal_quantile(p)), p, 1e-12 + 1e-9 * p);
    EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
}

TEST(Statistics, ChiSquaredSurvivalHasItsClosedForms) {
    for (const double x : {0.1, 1.0, 5.0, 40.0}) {
        EXPECT_NEAR(chi_squared_survival(x, 2), std::exp(-x / 2), 1e-13);                // two degrees: exponential
        EXPECT_NEAR(chi_squared_survival(x, 1), std::erfc(std::sqrt(x / 2)), 1e-12);     // one degree: normal tails
        EXPECT_NEAR(chi_squared_survival(x, 4), std::exp(-x / 2) * (1 + x / 2), 1e-13);  // four degrees
    }
}

TEST(Statistics, ChiSquaredDrawsHaveMeanAndVariance) {
    RandomStream random(3, 1);
    for (const double k : {0.7, 5.0, 30.0}) {
        double mean = 0.0, square = 0.0;
        constexpr int n = 40000;
        for (int i = 0; i < n; ++i) {
            const double x = draw_chi_squared(random, k);
            mean += x / n;
            square += x * x / n;
        }
        EXPECT_NEAR(mean, k, 5 * std::sqrt(2 * k / n));  // five standard errors
        EXPECT_NEAR(square - mean * mean, 2 * k, 0.1 * 2 * k);
    }
}

TEST(Statistics, BenjaminiHochbergOnTheirOwnExample) {
    // Benjamini & Hochberg 1995, section 3.2: fifteen p values, four discoveries at q = 0.05.
    const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0};
    const auto found = false_discovery_control(p, 0.05);
    EXPECT_EQ(std::count(found.begin(), found.end(), true), 4);
    const auto strict = false_discovery_control(p, 0.05, true);
    EXPECT_EQ(std::count(strict.begin(), strict.end(), true), 3);
    EXPECT_TRUE(found[0] && found[3] && !found[4]);
}

TEST(Statistics, ExpectedFalseDiscoveriesStopWhereTheMeanDoubtPassesTheRate) {
    // ascending means: 0.01, 0.015, 0.043, 0.158
    const auto found = expected_false_discovery_control({0.10, 0.50, 0.01, 0.02}, 0.05);
    EXPECT_EQ(found, (std::vector<bool>{true, false, true, true}));
    EXPECT_EQ(expected_false_discovery_control({0.06, 0.5}, 0.05), (std::vector<bool>{false, false}));
    EXPECT_TRUE(expected_false_discovery_control({}, 0.05).empty());
}

TEST(Statistics, HolmAdjustsStepByStep) {
    const auto p = holm({0.01, 0.04, 0.03, 0.005});
    EXPECT_DOUBLE_EQ(p[3], 0.02);
    EXPECT_DOUBLE_EQ(p[0], 0.03);
    EXPECT_DOUBLE_EQ(p[2], 0.06);
    EXPECT_DOUBLE_EQ(p[1], 0.06);  // never below its predecessor
}

TEST(Statistics, CalibrationScoreOfPerfectAndWrongForecasts) {
    const auto perfect = calibration_score({0.0, 0.0, 1.0, 1.0}, {false, false, true, true});
    EXPECT_DOUBLE_EQ(perfect.expected_error, 0.0);
    EXPECT_DOUBLE_EQ(perfect.brier, 0.0);
    const auto boast = calibration_score({0.95, 0.95, 0.95, 0.95}, {true, false, true, false});
    EXPECT_NEAR(boast.expected_error, 0.45, 1e-12);
    EXPECT_NEAR(boast.climatology_brier, 0.25, 1e-12);
}

TEST(Statistics, HaltonFillsEveryThirdAndHalf) {
    int low = 0, third = 0;
    for (std::uint64_t i = 1; i <= 600; ++i) {
        const auto x = halton(i, 2);
        low += x[0] < 0.5 ? 1 : 0;
        third += x[1] < 1.0 / 3 ? 1 : 0;
    }
    EXPECT_NEAR(low, 300, 1);
    EXPECT_NEAR(third, 200, 1);
}

TEST(Gaussian, WhitenedNoiseHasUnitCovarianceAndTheDensityIntegratesToItsClosedForm) {
    Eigen::Matrix2d sigma;
    sigma << 4.0, 1.0, 1.0, 2.0;
    const Whitener w{Eigen::MatrixXd(sigma)};
    EXPECT_TRUE(w.whiten_columns(w.factor()).isApprox(Eigen::MatrixXd::Identity(2, 2), 1e-14));
    EXPECT_NEAR(w.log_determinant(), std::log(7.0), 1e-14);
    // one dimension, ν = 1: Cauchy
    EXPECT_NEAR(log_student_density(4.0, 1, 0.0, 1.0), -std::log(M_PI * 5.0), 1e-13);
    // large ν: Gaussian
    EXPECT_NEAR(log_student_density(4.0, 3, 0.5, 1e9), log_student_density(4.0, 3, 0.5, std::numeric_limits<double>::infinity()), 1e-6);
    EXPECT_THROW(Whitener(Eigen::MatrixXd::Zero(2, 2)), std::runtime_error);
}

TEST(Gaussian, TheHeavyTailBeginsWhereTheDataStopFittingAndNeverSharpens) {
    const double at = log_heavy_tailed_likelihood(10.0, 10, 0.3, 4.0);
    EXPECT_NEAR(at, log_student_density(10.0, 10, 0.3, std::numeric_limits<double>::infinity()), 1e-12);  // Gaussian up to χ² = n
    EXPECT_NEAR(log_heavy_tailed_likelihood(10.0 + 1e-6, 10, 0.3, 4.0) - at, -0.5e-6, 1e-11);             // the same slope beyond
    // outside, differences are those of the Student t
    EXPECT_NEAR(log_heavy_tailed_likelihood(80.0, 10, 0.3, 4.0) - log_heavy_tailed_likelihood(50.0, 10, 0.3, 4.0),
                log_student_density(80.0, 10, 0.3, 4.0) - log_student_density(50.0, 10, 0.3, 4.0), 1e-12);
    // inside, a difference of χ² counts half of itself however good the fit is; the plain Student t would count it nearly five times
    EXPECT_NEAR(log_heavy_tailed_likelihood(10.0, 75, 0.0, 4.0) - log_heavy_tailed_likelihood(14.0, 75, 0.0, 4.0), 2.0, 1e-12);
    EXPECT_GT(log_student_density(10.0, 75, 0.0, 4.0) - log_student_density(14.0, 75, 0.0, 4.0), 9.0);
    for (const double chi2 : {1.0, 9.0, 30.0, 500.0}) {
        EXPECT_LE(heavy_tailed_weight(chi2, 10, 4.0), 1.0);
        const double slope = (log_heavy_tailed_likelihood(chi2 + 1e-4, 10, 0.0, 4.0) - log_heavy_tailed_likelihood(chi2 - 1e-4, 10, 0.0, 4.0)) / 2e-4;
        EXPECT_NEAR(heavy_tailed_weight(chi2, 10, 4.0), -2.0 * slope, 1e-6);
    }
}

TEST(Pod, FindsTheModesItWasMadeOfAndKeepsTheRestApart) {
    Eigen::MatrixXd y(50, 6);
    const Eigen::RowVectorXd a = (Eigen::RowVectorXd(6) << 1, 1, 1, 1, 1, 1).finished(), b = (Eigen::RowVectorXd(6) << 1, -1, 1, -1, 1, -1).finished();
    RandomStream random(1, 1);
    for (Eigen::Index i = 0; i < 50; ++i) y.row(i) = 3.0 * random.normal() * a + random.normal() * b;
    const Eigen::VectorXd weight = Eigen::VectorXd::Constant(6, 2.0);
    const PodBasis basis = make_pod(y, weight, 0.999999, 12);
    EXPECT_EQ(basis.modes.cols(), 2);
    EXPECT_TRUE((basis.modes.transpose() * weight.cwiseAbs2().asDiagonal() * basis.modes).isApprox(Eigen::MatrixXd::Identity(2, 2), 1e-12));
    EXPECT_LT(basis.residual(y.row(7).transpose()).norm(), 1e-12);
    Eigen::VectorXd stranger = basis.mean;
    stranger[0] += 1.0;
    stranger[2] -= 1.0;  // orthogonal to both modes
    EXPECT_NEAR(basis.residual(stranger).norm(), std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace pelletlab::inference
