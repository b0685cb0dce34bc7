// Figures that a verification test compares, recorded for the table of docs/verification.md (scripts/verification-table).
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace pelletlab::verification {

/// Expects |got − expected| ≤ tolerance and records the row «case | quantity | expected | got | tolerance».
inline void figure(const std::string& name, const std::string& quantity, double expected, double got, double tolerance, const char* tolerance_text = nullptr) {
    static int count = 0;
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, "%.6g | %.6g | ", expected, got);
    char within[40];
    std::snprintf(within, sizeof within, "%.2g", tolerance);
    ::testing::Test::RecordProperty("figure_" + std::to_string(++count),
                                    name + " | " + quantity + " | " + numbers + (tolerance_text ? tolerance_text : within));
    EXPECT_NEAR(got, expected, tolerance) << name << ": " << quantity;
}

/// The same with a tolerance relative to the expected value.
inline void figure_relative(const std::string& name, const std::string& quantity, double expected, double got, double share) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
    figure(name, quantity, expected, got, share * std::abs(expected), text);
}

/// Something that must stay below a bound.
inline void figure_below(const std::string& name, const std::string& quantity, double got, double bound) {
    char text[40];
    std::snprintf(text, sizeof text, "< %.2g", bound);
    figure(name, quantity, 0.0, got, bound, text);
}

}  // namespace pelletlab::verification
