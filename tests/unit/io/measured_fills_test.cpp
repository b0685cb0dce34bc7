#include "io/measured_fills.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"

namespace pelletlab::io {
namespace {

TEST(MeasuredFills, RowsOfOneFillAreRepeats) {
    const auto fills = parse_measured_fills("pellets, mass [g], height [mm]\n5212, 200, 90.0\n6515, 250, 112\n5212, 200, 92.0\n5212, 200, 91.0\n", "h.csv");
    ASSERT_EQ(fills.size(), 2u);
    EXPECT_EQ(fills[0].repeats, 3);
    EXPECT_NEAR(fills[0].height, 0.091, 1e-15);
    EXPECT_NEAR(fills[0].deviation, 0.001, 1e-12);
    EXPECT_NEAR(fills[0].mass, 0.2, 1e-15);
    EXPECT_EQ(fills[0].line, 2);
    EXPECT_TRUE(std::isnan(fills[1].deviation));
}

TEST(MeasuredFills, MeansAndDeviations) {
    const auto fills = parse_measured_fills("mass [g];mean [cm];sd [mm];n\n200;9,1;1,5;3\n", "h.csv");
    ASSERT_EQ(fills.size(), 1u);
    EXPECT_NEAR(fills[0].height, 0.091, 1e-15);
    EXPECT_NEAR(fills[0].deviation, 0.0015, 1e-15);
    EXPECT_EQ(fills[0].repeats, 3);
    EXPECT_EQ(fills[0].pellets, 0.0);
}

void refuses(const char* text, const char* place, const char* words) {
    try {
        parse_measured_fills(text, "h.csv");
        FAIL() << text;
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(place), std::string::npos) << what;
        EXPECT_NE(what.find(words), std::string::npos) << what;
    }
}

TEST(MeasuredFills, ErrorsHaveAPlace) {
    refuses("pellets,height\n5212,90\n", "h.csv:1:9", "no unit");
    refuses("pellets,height [g]\n5212,90\n", "h.csv:1:9", "length");
    refuses("height [mm]\n90\n", "h.csv:1", "how much was filled");
    refuses("pellets\n90\n", "h.csv:1", "height");
    refuses("pellets,height [mm]\n5212,-3\n", "h.csv:2:6", "above 0");
    refuses("pellets,height [mm]\n5212,tall\n", "h.csv:2:6", "tall");
    refuses("pellets,mean [mm],sd [mm]\n5212,90,1\n", "h.csv:1:9", "number of repeats");
    refuses("pellets,mean [mm],sd [mm],n\n5212,90,,3\n", "h.csv:2", "no standard deviation");
    refuses("pellets,height [mm]\n", "h.csv", "no row");
}

}  // namespace
}  // namespace pelletlab::io
