#include "observables/bed.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;
using namespace pelletlab::synthetic;

namespace {

double value_of(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o.value;
    ADD_FAILURE() << "no observable " << name;
    return not_known;
}

bool has(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return true;
    return false;
}

}  // namespace

TEST(TubeBed, BrickWallHasTheHeightAndPackingOfABrickWall) {
    // Boxes 2 × 2 × 1 mm laid side by side without gaps, five layers, over more than the tube: the surface is the plane z = 5 mm.
    const PelletShape brick = box_pellet(1e-3, 0.5e-3);
    Frame frame;
    for (int layer = 0; layer < 5; ++layer)
        for (int i = -12; i <= 12; ++i)
            for (int j = -12; j <= 12; ++j) add_body(frame, {i * 2e-3, j * 2e-3, (layer + 0.5) * 1e-3});
    const Trajectory trajectory = trajectory_of(brick, {frame});
    const Observables bed = measure_tube_bed(trajectory, {20e-3, 0.0, 0.7e-3});
    expect_documented(bed);
    // Exact geometry: rounding only. Bricks count by their centre, so those inside fill the circle's area to the share of one ring of bricks.
    EXPECT_NEAR(value_of(bed, "bed_height_grid"), 5.0, 1e-9);
    EXPECT_NEAR(value_of(bed, "bed_height_h95"), 5.0, 1e-9);
    EXPECT_NEAR(value_of(bed, "bed_height_h100"), 5.0, 1e-9);
    EXPECT_NEAR(value_of(bed, "bed_height_mass"), 5.0, 1e-9);
    EXPECT_NEAR(value_of(bed, "mean_centroid_height"), 2.5, 1e-9);
    EXPECT_NEAR(value_of(bed, "mean_axis_alignment"), 1.0, 1e-12);
    const double counted = value_of(bed, "pellets_counted");
    EXPECT_NEAR(value_of(bed, "packing_fraction_grid"), counted * 4e-9 / (pi * 400e-6 * 5e-3), 1e-9);
    EXPECT_NEAR(value_of(bed, "packing_fraction_grid"), 1.0, 0.03);
    // Slices of bricks: full below the surface, empty above it. Cut exactly, but bricks that reach across the wall lose a part there: the share of one ring.
    const double packing = value_of(bed, "packing_fraction_grid");
    const Profile& axial = bed.profiles[0];
    for (std::size_t k = 0; k < axial.axis.size(); ++k) {
        if (std::abs(axial.axis[k] - 5.0) < 0.2) continue;
        EXPECT_NEAR(axial.value[k], axial.axis[k] < 5.0 ? packing : 0.0, 0.1) << axial.axis[k] << " mm";
    }
}

TEST(TubeBed, FloorShiftsEveryHeight) {
    const PelletShape pellet = sphere_pellet(1e-3);
    Frame frame;
    add_body(frame, {0.0, 0.0, 0.101});
    add_body(frame, {0.0, 2e-3, 0.101});
    const Observables bed = measure_tube_bed(trajectory_of(pellet, {frame}), {10e-3, 0.1, 1e-3});
    EXPECT_NEAR(value_of(bed, "bed_height_h100"), 2.0, 1e-9);
    EXPECT_NEAR(value_of(bed, "bed_height_mass"), 2.0, 1e-9);
}

TEST(TubeBed, TopSurfaceOfOneSphereIsItsCap) {
    // Mean over the disc of radius a of r + √(r² − ρ²) with a = r − margin … here the sphere is as wide as the measured disc: mean cap height 2r/3, so
    // the mean height is 5r/3. The grid of r/100 leaves an error of order 1/100² of r, dominated by the rim's square root: 1e-3 r.
    const double r = 5e-3;
    Frame frame;
    add_body(frame, {0.0, 0.0, r});
    const Observables bed = measure_tube_bed(trajectory_of(sphere_pellet(r), {frame}), {2.0 * r, 0.0, r / 100.0});
    EXPECT_NEAR(value_of(bed, "bed_height_grid"), 1e3 * r * 5.0 / 3.0, 1e3 * r * 3e-3);
}

TEST(TubeBed, AFewPelletsOnABareFloorHaveNoGridHeight) {
    // The mean height of a bare floor with a pellet here and there is next to nothing, and the packing fraction from it was above 1.
    const double r = 1e-3;
    Frame frame;
    for (int k = 0; k < 4; ++k) add_body(frame, {5e-3 * (k % 2 ? 1 : -1), 5e-3 * (k / 2 ? 1 : -1), r});
    const Observables bed = measure_tube_bed(trajectory_of(sphere_pellet(r), {frame}), {20e-3, 0.0, r / 4.0});
    EXPECT_EQ(bed.status, "thin bed");
    EXPECT_TRUE(std::isnan(value_of(bed, "bed_height_grid")));
    EXPECT_TRUE(std::isnan(value_of(bed, "packing_fraction_grid")));
    EXPECT_NEAR(value_of(bed, "bed_height_h95"), 2.0, 1e-9);
    EXPECT_LT(value_of(bed, "packing_fraction_h95"), 1.0);
}

TEST(TubeBed, TrueSurfaceGoesBeforeSpheres) {
    PelletShape pellet = box_pellet(2e-3, 1e-3);
    pellet.rigid.spheres = {{Vec3::Zero(), 4e-3}};
    Frame frame;
    for (int i = -5; i <= 5; ++i)
        for (int j = -5; j <= 5; ++j) add_body(frame, {i * 4e-3, j * 4e-3, 1e-3});
    const Observables bed = measure_tube_bed(trajectory_of(pellet, {frame}), {15e-3, 0.0, 1e-3});
    EXPECT_NEAR(value_of(bed, "bed_height_grid"), 2.0, 1e-9);
    EXPECT_NEAR(value_of(bed, "bed_height_h95"), 2.0, 1e-9);
}

TEST(TubeBed, RandomOrientationsAverageOneHalf) {
    // |cos θ| is uniform on [0, 1]: mean 0.5, standard error 1/√(12 · 4000) = 0.0046; four of them are allowed.
    Frame frame;
    RandomStream random(3, 0);
    for (int i = 0; i < 4000; ++i) {
        const double rho = 18e-3 * std::sqrt(random.uniform()), phi = random.uniform(0.0, 2.0 * pi);
        add_body(frame, {rho * std::cos(phi), rho * std::sin(phi), random.uniform(0.0, 50e-3)}, random.rotation());
    }
    const Observables bed = measure_tube_bed(trajectory_of(box_pellet(1e-3, 0.5e-3), {frame}), {20e-3, 0.0, 1e-3});
    EXPECT_NEAR(value_of(bed, "mean_axis_alignment"), 0.5, 4 * 0.0046);
    // Centroids uniform over 50 mm: h_mass = 2·25 mm ± 2·50/√(12·4000) = 0.46 mm; 95th percentile 47.5 mm + half height 0.5 mm, ± 50·√(.95·.05/4000) = 0.17 mm.
    EXPECT_NEAR(value_of(bed, "bed_height_mass"), 50.0, 4 * 0.46);
    EXPECT_NEAR(value_of(bed, "bed_height_h95"), 48.0, 4 * 0.17);
    // The same volume in 60 % of h95: 0.6 · 4000 · 4 mm³ · (48/50) on average, ± √(0.58·0.42·4000) pellets = 1.4 %.
    const double core = 4000 * 4.0 * (0.6 * value_of(bed, "bed_height_h95") / 50.0) / (pi * 400.0 * 0.6 * value_of(bed, "bed_height_h95"));
    EXPECT_NEAR(value_of(bed, "packing_fraction_core"), core, 4 * 0.014 * core);
}

TEST(TubeBed, PelletWithoutAxisReportsNoAlignment) {
    Frame frame;
    add_body(frame, {0.0, 0.0, 1e-3});
    EXPECT_FALSE(has(measure_tube_bed(trajectory_of(sphere_pellet(1e-3), {frame}), {10e-3, 0.0, 1e-3}), "mean_axis_alignment"));
}

TEST(TubeBed, PelletsOutsideAreNotCounted) {
    Frame frame;
    add_body(frame, {0.0, 0.0, 1e-3});
    add_body(frame, {11e-3, 0.0, 1e-3});
    add_body(frame, {0.0, 0.0, -1e-3});
    EXPECT_EQ(value_of(measure_tube_bed(trajectory_of(sphere_pellet(1e-3), {frame}), {10e-3, 0.0, 1e-3}), "pellets_counted"), 1.0);
}

TEST(TubeBed, RefusesWhatItCannotMeasure) {
    Frame frame;
    add_body(frame, {0.0, 0.0, -1.0});
    const Trajectory outside = trajectory_of(sphere_pellet(1e-3), {frame});
    EXPECT_THROW(measure_tube_bed(outside, {10e-3, 0.0, 1e-3}), Error) << "no pellet inside";
    EXPECT_THROW(measure_tube_bed(outside, {0.0, 0.0, 1e-3}), Error) << "no radius";
    EXPECT_THROW(measure_tube_bed(Trajectory{}, {10e-3, 0.0, 1e-3}), Error) << "no frame";
}

TEST(TubeBed, APlateLiesOnThreePelletsThatEncloseTheAxis) {
    const double r = 1e-3;
    // Three spheres stand out of a flat bed. The plane that touches equal spheres is that of their centres, moved by r along its normal.
    const std::array<Vec3, 3> high{Vec3(8e-3, 1e-3, 10e-3), Vec3(-5e-3, 6e-3, 12e-3), Vec3(-4e-3, -7e-3, 11e-3)};
    Frame frame;
    for (const Vec3& p : high) add_body(frame, p);
    for (int i = -4; i <= 4; ++i)
        for (int j = -4; j <= 4; ++j) add_body(frame, {2e-3 * i, 2e-3 * j, r});
    // As high as the first and beside it towards the shell: below the plane, which rises towards the other two.
    add_body(frame, {8.5e-3, 1.0e-3, 9.6e-3});
    const Observables bed = measure_tube_bed(trajectory_of(sphere_pellet(r), {frame}), {15e-3, 0.0, 1e-3});
    Vec3 normal = (high[1] - high[0]).cross(high[2] - high[0]).normalized();
    if (normal.z() < 0.0) normal = -normal;
    const double middle = high[0].z() + (high[0].x() * normal.x() + high[0].y() * normal.y()) / normal.z() + r / normal.z();
    EXPECT_NEAR(value_of(bed, "bed_height_plate"), 1e3 * middle, 1e-4);  // the weight stands 1e-6 of the plate beside the axis
    EXPECT_NEAR(value_of(bed, "plate_tilt"), std::acos(normal.z()) * 180.0 / pi, 1e-6);
    EXPECT_NEAR(value_of(bed, "packing_fraction_plate") * value_of(bed, "bed_height_plate"),
                value_of(bed, "packing_fraction_mass") * value_of(bed, "bed_height_mass"), 1e-9);
}

TEST(TubeBed, APlateOnAFlatBedLiesFlat) {
    for (const bool spheres : {false, true}) {
        const PelletShape pellet = spheres ? sphere_pellet(1e-3) : box_pellet(1e-3, 1e-3);
        Frame frame;
        for (int i = -6; i <= 6; ++i)
            for (int j = -6; j <= 6; ++j) add_body(frame, {2e-3 * i, 2e-3 * j, 1e-3});
        const Observables bed = measure_tube_bed(trajectory_of(pellet, {frame}), {14e-3, 0.0, 1e-3});
        EXPECT_NEAR(value_of(bed, "bed_height_plate"), 2.0, 1e-5);
        EXPECT_NEAR(value_of(bed, "plate_tilt"), 0.0, 1e-4);
    }
}

TEST(TubeBed, APlateBalancesOnATiltedPlaneOfManyPellets) {
    // Centres on a plane of slope (0.2, −0.1) and others at random below it.
    const double r = 0.5e-3, a = 9e-3, b = 0.2, c = -0.1;
    Frame frame;
    for (std::uint64_t n = 0; n < 500; ++n) {
        RandomStream random(3, n);
        const double x = 0.018 * (random.uniform() - 0.5), y = 0.018 * (random.uniform() - 0.5);
        add_body(frame, {x, y, a + b * x + c * y - (n % 5 == 0 ? 0.0 : 4e-3 * random.uniform())});
    }
    const Observables bed = measure_tube_bed(trajectory_of(sphere_pellet(r), {frame}), {15e-3, 0.0, 1e-3});
    EXPECT_NEAR(value_of(bed, "bed_height_plate"), 1e3 * (a + r * std::sqrt(1.0 + b * b + c * c)), 1e-4);
    EXPECT_NEAR(value_of(bed, "plate_tilt"), std::atan(std::hypot(b, c)) * 180.0 / pi, 1e-3);
}

TEST(TubeBed, APlateSlidesOffPelletsThatLieOnOneSide) {
    Frame frame;
    for (int i = 1; i <= 3; ++i)
        for (int j = -1; j <= 1; ++j) add_body(frame, {3e-3 * i, 3e-3 * j, 1e-3});
    const Observables bed = measure_tube_bed(trajectory_of(sphere_pellet(1e-3), {frame}), {15e-3, 0.0, 1e-3});
    EXPECT_TRUE(std::isnan(value_of(bed, "bed_height_plate")));
    EXPECT_TRUE(std::isnan(value_of(bed, "packing_fraction_plate")));
}
