#include "core/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"

using namespace pelletlab;

namespace {
std::string message_of(const char* text, Dimension expected) {
    try {
        parse_quantity(text, expected);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        return error.what();
    }
    return {};
}
}  // namespace

TEST(Units, ReadsWhatPeopleWrite) {
    EXPECT_DOUBLE_EQ(parse_quantity("3.12 mm", dimension::length), 3.12e-3);
    EXPECT_DOUBLE_EQ(parse_quantity("3.12mm", dimension::length), 3.12e-3);
    EXPECT_DOUBLE_EQ(parse_quantity("  1e-5 s ", dimension::time), 1e-5);
    EXPECT_DOUBLE_EQ(parse_quantity("1800 kg/m^3", dimension::density), 1800.0);
    EXPECT_DOUBLE_EQ(parse_quantity("1.8 g/cm^3", dimension::density), 1800.0);
    EXPECT_DOUBLE_EQ(parse_quantity("20 rpm", dimension::rotation_speed), 40.0 * std::numbers::pi / 60.0);
    EXPECT_DOUBLE_EQ(parse_quantity("360 deg/s", dimension::rotation_speed), 2.0 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(parse_quantity("2 MPa", dimension::pressure), 2e6);
    EXPECT_DOUBLE_EQ(parse_quantity("20 %", dimension::none), 0.2);
    EXPECT_DOUBLE_EQ(parse_quantity("0.25", dimension::none), 0.25);
    EXPECT_DOUBLE_EQ(parse_quantity("72 mJ/m^2", dimension::surface_energy), 0.072);
    EXPECT_DOUBLE_EQ(parse_quantity("-9.81 m/s^2", dimension::acceleration), -9.81);
}

TEST(Units, SaysWhatIsWrong) {
    EXPECT_NE(message_of("3.12", dimension::length).find("has no unit"), std::string::npos);
    EXPECT_NE(message_of("3.12 mn", dimension::length).find("did you mean 'm"), std::string::npos);
    EXPECT_NE(message_of("3.12 s", dimension::length).find("a unit of time"), std::string::npos);
    EXPECT_NE(message_of("20 Hz", dimension::rotation_speed).find("a unit of frequency"), std::string::npos);
    EXPECT_NE(message_of("much mm", dimension::length).find("does not begin with a number"), std::string::npos);
    EXPECT_NE(message_of("nan mm", dimension::length).find("not a finite number"), std::string::npos);
    EXPECT_NE(message_of("1e999 mm", dimension::length).find("not a finite number"), std::string::npos);
    EXPECT_NE(message_of("1 m/", dimension::velocity).find("ends too early"), std::string::npos);
    EXPECT_NE(message_of("1 m^x", dimension::length).find("whole number"), std::string::npos);
}

TEST(Units, FormatReadsBackToTheSameBits) {
    for (const double value : {3.12e-3, 1.0 / 3.0, 2.0943951023931953, 1e-300})
        EXPECT_EQ(parse_quantity(format_quantity(value, "mm"), dimension::length), value) << value;
    EXPECT_EQ(format_quantity(3.12e-3, "mm"), "3.12 mm");
    EXPECT_EQ(format_quantity(0.25, ""), "0.25");
}
