#include "shapegen/hand_made.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.hpp"

namespace pelletlab::shapegen {
namespace {

std::vector<Sphere> read_csv_mm(const std::filesystem::path& file) {
    std::vector<Sphere> spheres;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        for (char& letter : line) letter = letter == ',' ? ' ' : letter;
        std::istringstream words(line);
        Sphere sphere;
        if (words >> sphere.centre[0] >> sphere.centre[1] >> sphere.centre[2] >> sphere.radius) {
            sphere.centre *= 1e-3;
            sphere.radius *= 1e-3;
            spheres.push_back(sphere);
        }
    }
    return spheres;
}

std::size_t count_radius(const std::vector<Sphere>& spheres, double radius) {
    std::size_t count = 0;
    for (const Sphere& sphere : spheres) count += std::abs(sphere.radius - radius) < 1e-12 ? 1 : 0;
    return count;
}

TEST(HandMade, CountsAndRadiiOfTable2) {
    const std::size_t big[] = {12, 24, 24, 48}, small[] = {0, 0, 18, 34};
    for (int number = 1; number <= 4; ++number) {
        const auto spheres = hand_made_shape(number);
        EXPECT_EQ(count_radius(spheres, 0.765e-3), big[number - 1]) << number;
        EXPECT_EQ(count_radius(spheres, 0.35e-3), small[number - 1]) << number;
        EXPECT_EQ(spheres.size(), big[number - 1] + small[number - 1]) << number;
    }
}

TEST(HandMade, NoSpherePokesOutAndTheSetTouchesTheCylinder) {
    for (int number = 1; number <= 4; ++number) {
        double side = 0.0, top = 0.0;
        for (const Sphere& sphere : hand_made_shape(number)) {
            side = std::max(side, sphere.centre.head<2>().norm() + sphere.radius);
            top = std::max(top, std::abs(sphere.centre.z()) + sphere.radius);
        }
        EXPECT_NEAR(side, 1.56e-3, 1e-15) << number;  // rounding only
        EXPECT_NEAR(top, 1.48e-3, 1e-15) << number;
    }
}

TEST(HandMade, Shape4IsLayoutA) {
    const std::filesystem::path file = std::filesystem::path(PELLETLAB_SHARED_DIR) / "peers/shape4_layout_A.csv";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "../shared/peers/shape4_layout_A.csv is not here";
    const auto expected = read_csv_mm(file);
    const auto spheres = hand_made_shape(4);
    ASSERT_EQ(spheres.size(), expected.size());
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        EXPECT_LT((spheres[i].centre - expected[i].centre).norm(), 1.8e-11) << i;  // the file has 8 decimals of a millimetre
        EXPECT_NEAR(spheres[i].radius, expected[i].radius, 1e-11) << i;
    }
}

TEST(HandMade, OtherNumbersAreAUsageError) {
    for (const int number : {0, 5, -1}) EXPECT_THROW(hand_made_shape(number), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
