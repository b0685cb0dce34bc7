#include "observables/pile.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "observables/detail/pile_surface.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/find.hpp"
#include "tests/unit/observables/synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;
using namespace pelletlab::synthetic;

namespace {

constexpr double degree = pi / 180.0;

/// Spheres whose centres lie densely on a cone: their union's top surface is the cone shifted outward by the radius, of the same slope, with its apex
/// higher by radius/cos(angle) (and a round tip).
struct ConeOfSpheres {
    double radius = 2e-3, slope = std::tan(30.0 * degree), base = 60e-3, x = 0.0, y = 0.0;
    double apex() const { return base * slope + radius / std::cos(std::atan(slope)); }
    Frame frame(std::size_t count, std::uint64_t seed) const {
        Frame result;
        RandomStream random(seed, 0);
        for (std::size_t k = 0; k < count; ++k) {
            const double rho = base * std::sqrt(random.uniform()), phi = random.uniform(0.0, 2.0 * pi);
            add_body(result, {x + rho * std::cos(phi), y + rho * std::sin(phi), (base - rho) * slope});
        }
        return result;
    }
};

}  // namespace

TEST(Pile, ConeHasItsAngleFromTheFitAndFromFourSides) {
    const ConeOfSpheres cone{2e-3, std::tan(30.0 * degree), 60e-3, 4e-3, -3e-3};
    PileGeometry geometry;
    geometry.axis_x = 1e-3;
    const Observables pile = measure_pile(trajectory_of(sphere_pellet(cone.radius), {cone.frame(20000, 1)}), geometry);
    expect_documented(pile);
    EXPECT_EQ(pile.status, "complete");
    // One sphere a 0.6 mm²: the union lies up to s²/8r = 0.04 mm below the ideal surface, and unevenly so by a third of that.
    EXPECT_NEAR(find(pile, "angle_of_repose_cone").value, 30.0, 0.1);
    EXPECT_NEAR(find(pile, "pile_height_cone").value, 1e3 * cone.apex(), 0.08);
    EXPECT_NEAR(find(pile, "pile_offset").value, std::hypot(3.0, 3.0), 0.1) << "the cone stands 3 mm beside the axis in x and in y";
    for (const char* side : {"plus_x", "minus_x", "plus_y", "minus_y", "sides"})
        EXPECT_NEAR(find(pile, std::string("angle_of_repose_") + side).value, 30.0, 0.3) << side;
    // The sectors scatter by far less than a degree on a perfect cone.
    EXPECT_GT(find(pile, "angle_of_repose_cone").standard_error, 0.0);
    EXPECT_LT(find(pile, "angle_of_repose_cone").standard_error, 0.1);
    // The highest sphere stands near the tip; the mean over a square of two diameters lies lower by slope · 0.3826 · 2d.
    EXPECT_NEAR(find(pile, "pile_height_highest").value, 1e3 * (cone.base * cone.slope + cone.radius), 0.5);
    EXPECT_NEAR(find(pile, "pile_height").value, 1e3 * (cone.apex() - cone.slope * 0.3826 * 8e-3), 0.3);
    EXPECT_EQ(find(pile, "pellets_counted").value, 20000.0);
}

TEST(Pile, RunOutAndBaseOfAConeAboutItsAxis) {
    const ConeOfSpheres cone;
    const Observables pile = measure_pile(trajectory_of(sphere_pellet(cone.radius), {cone.frame(20000, 2)}), {});
    // Centres spread evenly over the disc: 95 % of them lie within √0.95 of its radius, ± base · √(0.95 · 0.05 / 20000) / (2 · √0.95) = 0.05 mm.
    EXPECT_NEAR(find(pile, "run_out_95").value, 60.0 * std::sqrt(0.95), 0.2);
    EXPECT_GT(find(pile, "run_out_95").standard_error, 0.0);
    // Half a diameter high is the surface where apex − slope · ρ = 2 mm; rings are 2 mm wide and linear between.
    EXPECT_NEAR(find(pile, "base_radius").value, 1e3 * (cone.apex() - 2e-3) / cone.slope, 0.7);
    const Profile& profile = pile.profiles.at(0);
    std::size_t compared = 0;
    for (std::size_t k = 0; k < profile.axis.size(); ++k)
        if (profile.axis[k] > 10.0 && profile.axis[k] < 50.0) {
            EXPECT_NEAR(profile.value[k], 1e3 * cone.apex() - cone.slope * profile.axis[k], 0.15) << profile.axis[k];
            ++compared;
        }
    EXPECT_GE(compared, 18u);
}

TEST(Pile, PelletsInTheFunnelAndUnseenOnesDoNotCount) {
    const ConeOfSpheres cone;
    Frame frame = cone.frame(8000, 3);
    for (int k = 0; k < 100; ++k) add_body(frame, {0.0, 0.0, 0.2 + 1e-3 * k});
    add_body(frame, Vec3::Constant(not_known));
    PileGeometry geometry;
    geometry.ceiling = 0.15;
    const Observables pile = measure_pile(trajectory_of(sphere_pellet(cone.radius), {frame}), geometry);
    EXPECT_EQ(find(pile, "pellets_counted").value, 8000.0);
    EXPECT_EQ(find(pile, "pellets_above").value, 100.0);
    EXPECT_NEAR(find(pile, "angle_of_repose_cone").value, 30.0, 0.3);
}

TEST(Pile, ALayerIsNoPile) {
    Frame frame;
    RandomStream random(4, 0);
    for (int k = 0; k < 3000; ++k) add_body(frame, {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 2e-3});
    const Observables pile = measure_pile(trajectory_of(sphere_pellet(2e-3), {frame}), {});
    EXPECT_EQ(pile.status, "no pile");
    for (const Observable& o : pile.values) EXPECT_EQ(o.name.find("angle"), std::string::npos) << o.name;
    EXPECT_NEAR(find(pile, "pile_height_highest").value, 4.0, 0.05);
}

TEST(Pile, MovingPelletsAreNotAtRest) {
    const ConeOfSpheres cone;
    Frame frame = cone.frame(4000, 5);
    for (std::size_t k = 0; k < 300; ++k) frame.velocities[k] = {0.1, 0.0, 0.0};  // 7.5 % of them
    EXPECT_EQ(measure_pile(trajectory_of(sphere_pellet(cone.radius), {frame}), {}).status, "not at rest");
    for (std::size_t k = 0; k < 150; ++k) frame.velocities[k].setZero();  // 3.75 %: stragglers
    EXPECT_EQ(measure_pile(trajectory_of(sphere_pellet(cone.radius), {frame}), {}).status, "complete");
}

TEST(Pile, PackingOfABlockOfBricks) {
    // A block of bricks without gaps: the top surface is its top, and all below it is solid. Its grid lines on the block's rim count half a cell too much.
    Frame frame;
    for (int layer = 0; layer < 10; ++layer)
        for (int i = -9; i <= 9; ++i)
            for (int j = -9; j <= 9; ++j) add_body(frame, {i * 2e-3, j * 2e-3, (layer + 0.5) * 1e-3});
    PileGeometry geometry;
    geometry.height_grid = 0.5e-3;
    const Observables pile = measure_pile(trajectory_of(box_pellet(1e-3, 0.5e-3), {frame}), geometry);
    EXPECT_NEAR(find(pile, "pile_height").value, 10.0, 1e-9);
    // 38 mm wide, 77 lines of 0.5 mm: (38/38.5)² = 0.974, where the disc of the grid holds the corners of the block.
    EXPECT_NEAR(find(pile, "pile_packing_fraction").value, 38.0 * 38.0 / (38.5 * 38.5), 0.02);
}

TEST(Pile, RefusesWhatItCannotMeasure) {
    Frame frame;
    add_body(frame, {0.0, 0.0, -1.0});
    EXPECT_THROW(measure_pile(trajectory_of(sphere_pellet(1e-3), {frame}), {}), Error) << "nothing on the plate";
    EXPECT_THROW(measure_pile(Trajectory{}, {}), Error) << "no frame";
    PileGeometry coarse;
    coarse.height_grid = 0.0;
    EXPECT_THROW(measure_pile(trajectory_of(sphere_pellet(1e-3), {frame}), coarse), Error);
}
