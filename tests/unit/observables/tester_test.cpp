// Clouds and baffle loads that are known by construction.
#include "observables/tester.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "documented.hpp"
#include "find.hpp"
#include "observables/detail/tester_cloud.hpp"
#include "synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;

namespace {

constexpr double pi = std::numbers::pi, pellet_radius = 1.5e-3, speed = 2.0 * pi;  // a turn a second

TesterGeometry geometry() {
    TesterGeometry t;
    t.radius = 0.05;
    t.length = 0.03;
    t.baffle_height = 0.015;
    t.rotation_speed = speed;
    t.grid = 5e-3;
    return t;
}

/// Three turns with a frame every 5°. While the baffle's angle is below `release`, ten pellets ride on it; then they lie still in the middle of the drum.
/// Twenty always lie in a heap at the bottom at rest. For a drum that turns the other way all is mirrored.
Trajectory carried_until(double release, double mirror) {
    std::vector<Frame> frames;
    for (int k = 0; k <= 3 * 72; ++k) {
        Frame frame;
        frame.time = k / 72.0;
        const double angle = std::fmod(speed * frame.time + 1e-9, 2.0 * pi);
        const Vec3 out(-std::sin(angle) * mirror, 0.0, -std::cos(angle)), ahead(-std::cos(angle) * mirror, 0.0, std::sin(angle));
        const Vec3 omega = mirror * speed * Vec3::UnitY();
        for (int n = 0; n < 10; ++n) {
            const double y = -0.012 + 0.0026 * n;
            const Vec3 p = 0.045 * out + 0.004 * ahead + y * Vec3::UnitY();
            if (angle < release)
                synthetic::add_body(frame, p, Quat::Identity(), omega.cross(p));
            else
                synthetic::add_body(frame, Vec3(0.0, y, 0.0));
        }
        for (int n = 0; n < 20; ++n) synthetic::add_body(frame, Vec3(0.003 * (n % 4) - 0.0045, 0.003 * (n / 4) - 0.006, -0.048));
        frames.push_back(std::move(frame));
    }
    return synthetic::trajectory_of(synthetic::sphere_pellet(pellet_radius), std::move(frames));
}

}  // namespace

TEST(Tester, FindsTheAngleAtWhichTheBaffleIsEmptied) {
    for (const double mirror : {1.0, -1.0}) {
        TesterGeometry t = geometry();
        t.rotation_speed = mirror * speed;
        // At rest in the heap a pellet moves against the drum with ω R ≈ 0.3 m/s and does not count.
        const Observables result = measure_tester(carried_until(2.0, mirror), t, {0.0, 3.0});
        expect_documented(result);
        EXPECT_EQ(result.status, "complete");
        EXPECT_NEAR(find(result, "turns_measured").value, 3.0, 1e-9);
        EXPECT_NEAR(find(result, "baffle_load_largest").value, 10.0, 1e-9);
        // 2 rad are 114.6°: the last loaded frame is at 110°, in the bin of 110°–115° (centre 112.5°), the next bin's centre is 117.5°.
        EXPECT_NEAR(find(result, "release_angle_begin").value, 113.0, 1e-6);
        EXPECT_NEAR(find(result, "release_angle").value, 115.0, 1e-6);
        EXPECT_NEAR(find(result, "release_angle_end").value, 117.0, 1e-6);
        EXPECT_NEAR(find(result, "release_angle").standard_error, 0.0, 1e-9) << "all turns are alike";
    }
}

TEST(Tester, TurnsAreCountedFromTheBeginningOfTheWindow) {
    // A window that begins at 200°: two whole turns and 30° more, which do not count. Three pellets fall off earlier in the second of them.
    Trajectory trajectory = carried_until(2.0, 1.0);
    const auto begin = static_cast<std::size_t>(200 / 5), end = begin + 2 * 72 + 6;
    for (std::size_t k = begin + 72 + 40; k < trajectory.frames.size(); ++k)  // at 40° of the second turn
        if (k < begin + 2 * 72)
            for (std::size_t n = 0; n < 3; ++n) trajectory.frames[k].velocities[n] = Vec3(1.0, 0.0, 0.0);
    const Observables result = measure_tester(trajectory, geometry(), {static_cast<double>(begin) / 72.0, static_cast<double>(end) / 72.0});
    const Profile& load = profile_of(result, "baffle_load");
    ASSERT_EQ(load.axis.size(), 72u);
    EXPECT_NEAR(load.value[10], 0.5 * (10.0 + 7.0), 1e-9) << "52.5°, once in each turn";
    EXPECT_NEAR(load.standard_error[10], 1.5, 1e-9) << "s / √2 of 10 and 7";
    // The load falls below nine tenths at 113° in the first turn, between 37.5° and 42.5° in the second and in the mean: the jackknife over two turns.
    const double mean = 37.5 + 5.0 * 1.0 / 1.5, without_first = 37.5 + 5.0 * 1.0 / 3.0, without_second = 112.5 + 5.0 * 1.0 / 10.0;
    EXPECT_NEAR(find(result, "release_angle_begin").value, mean, 1e-6);
    EXPECT_NEAR(find(result, "release_angle_begin").standard_error, std::sqrt(0.5 * (std::pow(without_first - mean, 2) + std::pow(without_second - mean, 2))),
                1e-6);
}

TEST(Tester, MapsHoldAllThePelletsVolume) {
    const TesterGeometry t = geometry();
    const Observables result = measure_tester(carried_until(2.0, 1.0), t, {0.0, 3.0});
    const double volume = 30.0 * 4.0 / 3.0 * pi * pellet_radius * pellet_radius * pellet_radius;
    const detail::ViewGrid grid = detail::ViewGrid::over(t.radius, 20, 20);
    const std::vector<double> area = grid.area_inside(t.radius);
    for (const char* name : {"cloud_000", "cloud_045", "cloud_090", "cloud_135", "cloud_315"}) {
        const FieldMap& map = map_of(result, name);
        ASSERT_EQ(map.value.size(), area.size());
        double seen = 0.0;
        for (std::size_t cell = 0; cell < area.size(); ++cell)
            if (std::isfinite(map.value[cell])) seen += map.value[cell] * area[cell] * t.length;
        EXPECT_NEAR(seen, volume, 1e-6 * volume) << name;
    }
    // On the left at 90°: 10 pellets at 45 mm, 4 mm above the middle; 20 below the axis.
    EXPECT_NEAR(find(result, "centre_x_090").value, -45.0 / 3.0, 1e-6);
    EXPECT_NEAR(find(result, "centre_z_090").value, (4.0 - 2.0 * 48.0) / 3.0, 1e-6);
    EXPECT_NEAR(find(result, "centre_z_180").value, -2.0 * 48.0 / 3.0, 1e-6) << "they have left the baffle";
    EXPECT_NEAR(find(result, "centre_z_180").standard_error, 0.0, 1e-9);
}

TEST(Tester, LoosePelletsHaveNoCompany) {
    Frame frame;
    for (int n = 0; n < 27; ++n) synthetic::add_body(frame, 3e-3 * Vec3(n % 3, (n / 3) % 3, n / 9));  // each has 3 neighbours or more at 3 mm
    for (int n = 0; n < 9; ++n) synthetic::add_body(frame, Vec3(0.02 + 0.01 * n, 0.0, 0.0));
    const Trajectory trajectory = synthetic::trajectory_of(synthetic::sphere_pellet(pellet_radius), {frame});
    EXPECT_NEAR(detail::loose_share(trajectory.head, frame, detail::sample_shapes(trajectory.head, 30)), 9.0 / 36.0, 1e-12);
}

TEST(Tester, ReleaseAngleIsInterpolatedAndMayPassTheBottom) {
    const std::array<double, 4> angle{0.25 * pi, 0.75 * pi, 1.25 * pi, 1.75 * pi};
    EXPECT_NEAR(detail::release_angle(angle, std::array<double, 4>{8.0, 10.0, 2.0, 0.0}, 0.5), 0.75 * pi + 0.5 * pi * 5.0 / 8.0, 1e-12);
    EXPECT_NEAR(detail::release_angle(angle, std::array<double, 4>{0.0, 1.0, 9.0, 10.0}, 0.5), 2.0 * pi - 0.25 * pi + 0.5 * pi * 0.5, 1e-12);
    EXPECT_TRUE(std::isnan(detail::release_angle(angle, std::array<double, 4>{0.1, 0.2, 0.3, 0.1}, 0.5))) << "less than a pellet";
    EXPECT_TRUE(std::isnan(detail::release_angle(angle, std::array<double, 4>{8.0, 9.0, 10.0, 8.0}, 0.5))) << "it stays on";
}

TEST(Tester, RefusesWhatCannotBeMeasured) {
    const Trajectory trajectory = carried_until(2.0, 1.0);
    TesterGeometry t = geometry();
    t.rotation_speed = 0.0;
    EXPECT_THROW(measure_tester(trajectory, t, {0.0, 3.0}), Error);
    t = geometry();
    EXPECT_THROW(measure_tester(trajectory, t, {5.0, 6.0}), Error);
    t.radius = 0.0;
    EXPECT_THROW(measure_tester(trajectory, t, {0.0, 3.0}), Error);
    EXPECT_EQ(measure_tester(trajectory, geometry(), {0.0, 1.2}).status, "too few turns");
    Trajectory sparse = trajectory;  // a frame every 15°, from 5° on: at 5°, 50°, … never within 3° of 45°
    sparse.frames.clear();
    for (std::size_t k = 1; k < trajectory.frames.size(); k += 3) sparse.frames.push_back(trajectory.frames[k]);
    EXPECT_EQ(measure_tester(sparse, geometry(), {0.0, 3.0}).status, "frames too far apart");
}
