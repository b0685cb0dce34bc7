#include "shapegen/dem_cost.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "shapegen/hand_made.hpp"

namespace pelletlab::shapegen {
namespace {

MassProperties ball_mass(double radius, double density) {
    MassProperties mass;
    mass.volume = 4.0 / 3.0 * M_PI * radius * radius * radius;
    mass.density = density;
    mass.mass = density * mass.volume;
    mass.principal_inertia = Vec3::Constant(0.4 * mass.mass * radius * radius);
    return mass;
}

TEST(DemCost, OfOneBallInClosedForm) {
    const double radius = 1e-3, density = 2000.0;
    const MassProperties mass = ball_mass(radius, density);
    DemCostSettings settings;
    settings.press = 1e-5;
    const std::vector<Sphere> ball = {{Vec3::Zero(), radius}};
    const DemCost cost = dem_cost(ball, mass, settings);
    // Between two planes: normal 2k, tangential 2·(2/3·…)k on mass and rotation: k_t (1/m + r²/I) = 3.5 k_t/m is the stiffest.
    const double nu = settings.poisson_ratio, k = 2.0 * settings.shear_modulus / (1.0 - nu) * std::sqrt(radius * settings.press);
    const double kt = 2.0 * (1.0 - nu) / (2.0 - nu) * k;
    // Opposite tangential contacts do not couple shift and spin: shift 2 k_t/m, spin 2 k_t r²/I = 5 k_t/m.
    const double largest = std::max(2.0 * k, 5.0 * kt) / mass.mass;
    EXPECT_NEAR(cost.time_step / (2.0 / std::sqrt(largest)), 1.0, 1e-9);
    EXPECT_DOUBLE_EQ(cost.contacts_mean, 1.0);
    EXPECT_EQ(cost.contacts_most, 1u);
    EXPECT_DOUBLE_EQ(cost.work, settings.work_of_pellet + settings.work_of_sphere + 0.5 * settings.neighbours);
}

TEST(DemCost, CoplanarSpheresShareTheirFaceAndCostTheStep) {
    // Four spheres in a square: a plane from above meets all four at once, four times as stiff.
    const double r = 0.5e-3;
    std::vector<Sphere> square;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) square.push_back({{x * r, y * r, 0.0}, r});
    MassProperties mass = ball_mass(1e-3, 2000.0);
    mass.principal_inertia *= 100.0;  // spin out of the way: only shifts count
    DemCostSettings settings;
    settings.press = 1e-6;
    const double four = dem_cost(square, mass, settings).time_step, one = dem_cost(std::vector<Sphere>{{Vec3::Zero(), r}}, mass, settings).time_step;
    EXPECT_NEAR(one / four, 2.0, 1e-6);
    EXPECT_EQ(dem_cost(square, mass, settings).contacts_most, 4u);
}

TEST(DemCost, HandMadeShapesRankAsTheStudySays) {
    // More spheres cost more, and Shape 4 far more than twice Shape 2: 33 of its spheres meet a flat wall at once (shapes.md).
    const DemCost second = dem_cost_of_shape_2(1800.0);
    EXPECT_EQ(second.contacts_most, 8u);  // a ring
    EXPECT_GT(second.time_step, 0.0);
    // Denser pellets have longer steps, by the square root.
    EXPECT_NEAR(dem_cost_of_shape_2(7200.0).time_step / second.time_step, 2.0, 1e-9);
    EXPECT_NEAR(dem_cost_of_shape_2(7200.0).work / second.work, 1.0, 1e-12);
}

TEST(DemCost, NothingToPriceIsAnError) {
    EXPECT_THROW(dem_cost({}, ball_mass(1e-3, 1000.0)), Error);
    EXPECT_THROW(dem_cost(std::vector<Sphere>{{Vec3::Zero(), 1e-3}}, MassProperties{}), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
