#include "core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace pelletlab;

TEST(Random, PhiloxMatchesPublishedKnownAnswers) {
    // kat_vectors of Random123 (Salmon et al. 2011), philox4x32 with 10 rounds.
    const auto zeros = philox4x32({0, 0, 0, 0}, {0, 0});
    EXPECT_EQ(zeros[0], 0x6627e8d5u);
    EXPECT_EQ(zeros[1], 0xe169c58du);
    EXPECT_EQ(zeros[2], 0xbc57ac4cu);
    EXPECT_EQ(zeros[3], 0x9b00dbd8u);
    const auto ones = philox4x32({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u});
    EXPECT_EQ(ones[0], 0x408f276du);
    EXPECT_EQ(ones[1], 0x41c83b0eu);
    EXPECT_EQ(ones[2], 0xa20bc7c6u);
    EXPECT_EQ(ones[3], 0x6d5451fdu);
}

TEST(Random, StreamsAreReproducibleAndDifferent) {
    RandomStream a(7, 1), same(7, 1), other(7, 2);
    const double first = a.uniform();
    EXPECT_EQ(first, same.uniform());
    EXPECT_NE(first, other.uniform());
}

TEST(Random, MomentsOfUniformNormalAndRotation) {
    RandomStream stream(1, 0);
    const int n = 200000;
    double mean = 0.0, variance = 0.0, normal_mean = 0.0, normal_square = 0.0;
    Mat3 second_moment = Mat3::Zero();
    for (int i = 0; i < n; ++i) {
        const double u = stream.uniform();
        mean += u / n;
        variance += (u - 0.5) * (u - 0.5) / n;
        const double g = stream.normal();
        normal_mean += g / n;
        normal_square += g * g / n;
        const Vec3 axis = stream.rotation() * Vec3::UnitZ();
        second_moment += axis * axis.transpose() / n;
    }
    EXPECT_NEAR(mean, 0.5, 0.004);  // 6 standard errors: 6·0.289/√n
    EXPECT_NEAR(variance, 1.0 / 12.0, 0.002);
    EXPECT_NEAR(normal_mean, 0.0, 0.014);
    EXPECT_NEAR(normal_square, 1.0, 0.02);
    EXPECT_LT((second_moment - Mat3::Identity() / 3.0).cwiseAbs().maxCoeff(), 0.006);
}
