#include "shapegen/union_properties.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "shapegen/hand_made.hpp"

namespace pelletlab::shapegen {
namespace {

TEST(SumProperties, TwoSpheresByHand) {
    // Radii 1 and 2, 3 apart along x: masses 1 : 8, centre at 8/3 from the small one.
    const std::vector<Sphere> spheres{{{1.0, 5.0, 0.0}, 1.0}, {{4.0, 5.0, 0.0}, 2.0}};
    const MassProperties sum = sum_mass_properties(spheres, 3.0);
    const double m = 3.0 * 4.0 / 3.0 * std::numbers::pi;
    EXPECT_NEAR(sum.mass / (9.0 * m), 1.0, 1e-14);
    EXPECT_LT((sum.centre_of_mass_mesh - Vec3(1.0 + 8.0 / 3.0, 5.0, 0.0)).norm(), 1e-14);
    const double along = 0.4 * m * (1.0 + 8.0 * 4.0), across = along + m * 8.0 / 9.0 * 9.0;  // reduced mass 8/9, distance 3
    EXPECT_NEAR(sum.principal_inertia[2] / along, 1.0, 1e-12);                               // axisymmetric: its axis is z
    EXPECT_NEAR(sum.principal_inertia[0] / across, 1.0, 1e-12);
}

TEST(SumProperties, EqualTheUnionWithoutOverlapsAndFarExceedItForShape4) {
    const std::vector<Sphere> apart{{{0, 0, 0}, 1e-3}, {{3e-3, 0, 0}, 1e-3}, {{0, 4e-3, 1e-3}, 0.5e-3}};
    const MassProperties sum = sum_mass_properties(apart, 1000.0), exact = union_mass_properties(apart, 1000.0);
    EXPECT_NEAR(sum.mass / exact.mass, 1.0, 1e-9);
    EXPECT_LT((sum.principal_inertia - exact.principal_inertia).norm() / exact.principal_inertia.norm(), 1e-6);
    const auto shape4 = hand_made_shape(4);
    EXPECT_NEAR(sum_mass_properties(shape4, 1.0).volume / 22.63e-9, 4.25, 0.01);  // shapes.md: «4.25 x the body»
}

TEST(SumProperties, NothingToWeighIsAnError) {
    EXPECT_THROW(sum_mass_properties({}, 1.0), Error);
    EXPECT_THROW(sum_mass_properties(std::vector<Sphere>{{Vec3::Zero(), 1.0}}, 0.0), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
