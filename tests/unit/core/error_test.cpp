#include "core/error.hpp"

#include <gtest/gtest.h>

#include <vector>

using namespace pelletlab;

TEST(ErrorText, NamesPlaceProblemAndRemedy) {
    const Error error = bad_input("unknown key 'sed'", "did you mean 'seed'?", {"case.toml", 3, 1});
    EXPECT_STREQ(error.what(), "case.toml:3:1: unknown key 'sed'\n  what to do: did you mean 'seed'?");
    EXPECT_EQ(error.exit_code(), 3);
    EXPECT_EQ(usage_error("x").exit_code(), 2);
    EXPECT_EQ(numerical_failure("x").exit_code(), 4);
}

TEST(ErrorText, SuggestsTheClosestWordOnly) {
    const std::vector<std::string> words{"seed", "speed", "diameter"};
    EXPECT_EQ(closest_word("sed", words), "seed");
    EXPECT_EQ(closest_word("diametr", words), "diameter");
    EXPECT_EQ(closest_word("viscosity", words), "");
}
