#include "packing/insertion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/error.hpp"

using namespace pelletlab;
using namespace pelletlab::packing;

namespace {

constexpr double pi = std::numbers::pi;

/// The study's cylinder, 3.12 × 2.96 mm: its corner lies 2.15 mm from the centre.
RigidTemplate study_pellet() {
    RigidTemplate pellet;
    pellet.name = "cylinder";
    pellet.spheres = {{Vec3::Zero(), 2.15e-3}};
    pellet.bounding_radius = 2.15e-3;
    pellet.mass_properties.volume = pi * 0.25 * 3.12e-3 * 3.12e-3 * 2.96e-3;
    return pellet;
}

double closest_distance(const std::vector<solver::BodyPlacement>& bodies) {
    double closest = 1.0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, (bodies[i].pose.position - bodies[j].pose.position).norm());
    return closest;
}

std::string problem_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        return error.problem();
    }
    return "no error";
}

}  // namespace

TEST(LooseCloud, ReachesATwentyPercentCloudInTheStudysTube) {
    const RigidTemplate pellet = study_pellet();
    const double radius = 26e-3;
    const std::uint32_t count = 1000;
    const double height = count * pellet.mass_properties.volume / (0.20 * pi * radius * radius);  // 20 % of the whole tube's volume, ends included
    const InsertionRegion region{InsertionRegion::Axis::z, radius, 0.0, height};
    const auto cloud = loose_cloud(pellet, count, region, 1, {0.0, 0.0, -0.5});
    ASSERT_EQ(cloud.size(), count);
    EXPECT_GT(closest_distance(cloud), 2.0 * pellet.bounding_radius);
    for (const auto& body : cloud) {
        const Vec3& p = body.pose.position;
        EXPECT_LE(std::hypot(p.x(), p.y()) + pellet.bounding_radius, radius);
        EXPECT_GE(p.z() - pellet.bounding_radius, 0.0);
        EXPECT_LE(p.z() + pellet.bounding_radius, height);
        EXPECT_EQ(body.velocity.z(), -0.5);
    }
    EXPECT_GT(cloud_capacity(pellet, region), 1.5 * count);
}

TEST(LooseCloud, IsRandomInPlaceAndOrientation) {
    const RigidTemplate pellet = study_pellet();
    const InsertionRegion region{InsertionRegion::Axis::z, 26e-3, 0.0, 53e-3};
    const auto cloud = loose_cloud(pellet, 1000, region, 2, Vec3::Zero());
    // |axis·z| uniform: 0.5 ± 0.289/√1000 = 0.0091, four of them.
    double alignment = 0.0, height = 0.0;
    for (const auto& body : cloud) {
        alignment += std::abs((body.pose.orientation * Vec3::UnitZ()).z()) / 1000.0;
        height += body.pose.position.z() / 1000.0;
    }
    EXPECT_NEAR(alignment, 0.5, 4 * 0.0091);
    EXPECT_NEAR(height, 26.5e-3, 2e-3) << "spread over the whole height (uniform: ± 0.5 mm)";
    // No layers left away from the ends (hard spheres always line up along a wall): the order parameter |Σ exp(2πi z/d)|/N is 1 for perfect layers and of order
    // 1/√650 = 0.04 for none; it is looked for at every distance that layers could have, and a dense fluid keeps some short-range order.
    double strongest = 0.0;
    for (double distance = 3.0e-3; distance < 6.0e-3; distance += 0.02e-3) {
        double c = 0.0, s = 0.0, n = 0.0;
        for (const auto& body : cloud) {
            const double z = body.pose.position.z();
            if (z < 8e-3 || z > 45e-3) continue;
            c += std::cos(2.0 * pi * z / distance);
            s += std::sin(2.0 * pi * z / distance);
            n += 1.0;
        }
        strongest = std::max(strongest, std::hypot(c, s) / n);
    }
    EXPECT_LT(strongest, 0.25);
}

TEST(LooseCloud, DependsOnTheSeedAlone) {
    const RigidTemplate pellet = study_pellet();
    const InsertionRegion region{InsertionRegion::Axis::z, 26e-3, 0.0, 53e-3};
    const auto a = loose_cloud(pellet, 500, region, 7, Vec3::Zero()), b = loose_cloud(pellet, 500, region, 7, Vec3::Zero());
    const auto other = loose_cloud(pellet, 500, region, 8, Vec3::Zero());
    std::size_t moved = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].pose.position, b[i].pose.position);
        EXPECT_EQ(a[i].pose.orientation.coeffs(), b[i].pose.orientation.coeffs());
        moved += a[i].pose.position != other[i].pose.position ? 1 : 0;
    }
    EXPECT_EQ(moved, a.size());
}

TEST(LooseCloud, FillsALyingCylinderUpToItsCeiling) {
    const RigidTemplate pellet = study_pellet();
    const InsertionRegion region{InsertionRegion::Axis::y, 40e-3, -10e-3, 10e-3, 5e-3};
    const auto cloud = loose_cloud(pellet, 500, region, 3, Vec3::Zero());
    EXPECT_GT(closest_distance(cloud), 2.0 * pellet.bounding_radius);
    for (const auto& body : cloud) {
        const Vec3& p = body.pose.position;
        EXPECT_LE(std::hypot(p.x(), p.z()) + pellet.bounding_radius, 40e-3);
        EXPECT_LE(std::abs(p.y()) + pellet.bounding_radius, 10e-3);
        EXPECT_LE(p.z() + pellet.bounding_radius, 5e-3);
    }
}

TEST(LooseCloud, SaysHowManyFit) {
    const RigidTemplate pellet = study_pellet();
    const InsertionRegion region{InsertionRegion::Axis::z, 26e-3, 0.0, 20e-3};
    const std::uint32_t most = cloud_capacity(pellet, region);
    EXPECT_GT(most, 200u);
    EXPECT_EQ(loose_cloud(pellet, most, region, 1, Vec3::Zero()).size(), most);
    const std::string problem = problem_of([&] { loose_cloud(pellet, most + 1, region, 1, Vec3::Zero()); });
    EXPECT_NE(problem.find("more pellets than fit"), std::string::npos) << problem;
    EXPECT_NE(problem.find(std::to_string(most) + " can be placed"), std::string::npos) << problem;
}

TEST(LooseCloud, NarrowTubeTakesASingleFile) {
    const RigidTemplate pellet = study_pellet();
    const InsertionRegion region{InsertionRegion::Axis::z, 2.2e-3, 0.0, 10.01 * 4.3e-3};
    EXPECT_EQ(loose_cloud(pellet, 10, region, 1, Vec3::Zero()).size(), 10u);
}

TEST(LooseCloud, RefusesAPelletLargerThanItsTube) {
    const RigidTemplate pellet = study_pellet();
    for (const InsertionRegion& region :
         {InsertionRegion{InsertionRegion::Axis::z, 2e-3, 0.0, 1.0}, InsertionRegion{InsertionRegion::Axis::y, 1.0, 0.0, 4e-3}}) {
        const std::string problem = problem_of([&] { loose_cloud(pellet, 1, region, 1, Vec3::Zero()); });
        EXPECT_NE(problem.find("pellet larger than its tube"), std::string::npos) << problem;
    }
    EXPECT_EQ(problem_of([&] { loose_cloud(pellet, 1, {InsertionRegion::Axis::z, 0.0, 0.0, 1.0}, 1, Vec3::Zero()); }), "the space for the pellets has no size");
}

TEST(LooseCloud, HasRoomForTheStudysDrum) {
    // 22,000 pellets in the lower 58 % of a 240 × 90 mm drum.
    EXPECT_GE(cloud_capacity(study_pellet(), {InsertionRegion::Axis::y, 120e-3, -45e-3, 45e-3, 20e-3}), 22000u);
}
