#include "observables/steady.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/unit/observables/synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;
using namespace pelletlab::synthetic;

namespace {

/// Exponential approach with time constant tau (in values) plus autoregressive noise of unit standard deviation and correlation 0.5.
std::vector<double> approach(std::size_t n, double jump, double tau, std::uint64_t seed) {
    std::vector<double> series;
    RandomStream random(seed, 0);
    double noise = random.normal();
    for (std::size_t k = 0; k < n; ++k) {
        series.push_back(10.0 + jump * std::exp(-static_cast<double>(k) / tau) + noise);
        noise = 0.5 * noise + std::sqrt(0.75) * random.normal();
    }
    return series;
}

}  // namespace

TEST(SteadyOnset, FindsTheEndOfATransient) {
    // Dropping a value pays while (y_d − ȳ)² exceeds twice the variance of the rest: the cut comes where transient plus noise sinks below 1.4 standard
    // deviations. With noise of up to 1.6 that is where the transient is below 3, and no later than where it is a twentieth.
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const SteadyOnset onset = steady_onset(approach(200, 50.0, 10.0, seed), 1);
        ASSERT_TRUE(onset.found) << seed;
        EXPECT_GT(onset.index, 10.0 * std::log(50.0 / 3.0)) << seed;
        EXPECT_LT(onset.index, 10.0 * std::log(50.0 / 0.05)) << seed;
        EXPECT_GT(onset.standard_error, 0.0) << seed;
        EXPECT_LT(onset.standard_error, 30.0) << seed;
    }
}

TEST(SteadyOnset, AStationarySeriesIsSteadyFromTheBegin) {
    double worst = 0.0;
    for (std::uint64_t seed = 11; seed <= 15; ++seed) {
        const SteadyOnset onset = steady_onset(approach(200, 0.0, 10.0, seed), 1);
        ASSERT_TRUE(onset.found);
        worst = std::max(worst, onset.index - 3.0 * onset.standard_error);
    }
    EXPECT_LE(worst, 10.0) << "no cut much later than its own error tells";
}

TEST(SteadyOnset, ADriftOverTheWholeSeriesHasNone) {
    std::vector<double> drift;
    for (int k = 0; k < 100; ++k) drift.push_back(0.1 * k * k);
    EXPECT_FALSE(steady_onset(drift, 1).found);
    EXPECT_FALSE(steady_onset(std::vector<double>(10, 1.0), 1).found) << "too short";
}

TEST(SteadyOnset, SameSeedSameBits) {
    const std::vector<double> series = approach(100, 20.0, 5.0, 3);
    EXPECT_EQ(steady_onset(series, 7).standard_error, steady_onset(series, 7).standard_error);
}

TEST(SteadyOnset, DrumThatTiltsAndThenStays) {
    // One pellet: at rest for 0.5 s; then the wall turns, the pellet climbs with 20 °/s for 2 s to 40° and stays there for 6 s with a little noise.
    Trajectory trajectory;
    std::vector<Frame> frames;
    RandomStream random(21, 0);
    for (int k = 0; k <= 170; ++k) {
        Frame frame;
        frame.time = 0.05 * k;
        const double t = frame.time - 0.5, angle = (std::min(std::max(t, 0.0), 2.0) * 20.0 + 0.2 * random.normal()) * pi / 180.0;
        add_body(frame, {-0.03 * std::sin(angle), 0.0, -0.03 * std::cos(angle)});
        frame.wall_poses = {{Vec3::Zero(), Quat(Eigen::AngleAxisd(std::max(t, 0.0), Vec3::UnitY()))}};
        frames.push_back(frame);
    }
    const Observable onset = drum_steady_onset(trajectory_of(sphere_pellet(2e-3), std::move(frames)));
    EXPECT_NEAR(onset.window.begin, 0.5, 0.06);
    // Any cut behind the rise leaves the same mean, so chance decides how late it comes: by less than a fifth of the 6 s of rest.
    EXPECT_GT(onset.value, 2.4) << "not within the rise";
    EXPECT_LT(onset.value, 2.5 + 0.2 * 6.0);
    EXPECT_GT(onset.standard_error, 0.0);
}
