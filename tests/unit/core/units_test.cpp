#include "core/units.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"

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

TEST(Units, PowersOfTenAreRoundedOnce) {
    // The text with a unit is the same double as the literal in SI, bit for bit: no multiplication by a rounded 1e-3.
    EXPECT_EQ(parse_quantity("3.12 mm", dimension::length), 3.12e-3);
    EXPECT_EQ(parse_quantity("0.765 mm", dimension::length), 0.765e-3);
    EXPECT_EQ(parse_quantity("22.63 mm^3", dimension::volume), 22.63e-9);
    EXPECT_EQ(parse_quantity("+3e9 GPa", dimension::pressure), 3e18);
    EXPECT_EQ(parse_quantity("1e-320 mm", dimension::length), 1e-323);
    EXPECT_EQ(parse_quantity("1e-323 um", dimension::length), 0.0);
    EXPECT_EQ(unit_factor("mm^3", dimension::volume), 1e-9);
    EXPECT_NE(message_of("1e306 km", dimension::length).find("not a finite number in SI"), std::string::npos);
    EXPECT_NE(message_of("0x10 mm", dimension::length).find("unknown unit 'x10'"), std::string::npos);
    EXPECT_NE(message_of("+-1 mm", dimension::length).find("does not begin with a number"), std::string::npos);
}

TEST(Units, EveryDoubleHasATextInEveryDecimalUnit) {
    RandomStream random(7, 0);
    for (int i = 0; i < 20000; ++i) {
        const double value = std::bit_cast<double>(random.bits());
        if (!std::isfinite(value)) continue;
        EXPECT_EQ(parse_quantity(format_quantity(value, "mm"), dimension::length), value);
        EXPECT_EQ(parse_quantity(format_quantity(value, "g*mm^2"), dimension::moment_of_inertia), value);
        EXPECT_EQ(parse_quantity(format_quantity(value, "%"), dimension::none), value);
        EXPECT_EQ(parse_quantity(format_quantity(value, "rpm"), dimension::rotation_speed), value);
    }
}

TEST(Units, FormatReadsBackToTheSameBits) {
    for (const double value : {3.12e-3, 1.0 / 3.0, 2.0943951023931953, 1e-300})
        EXPECT_EQ(parse_quantity(format_quantity(value, "mm"), dimension::length), value) << value;
    EXPECT_EQ(format_quantity(3.12e-3, "mm"), "3.12 mm");
    EXPECT_EQ(format_quantity(0.25, ""), "0.25");
    EXPECT_EQ(format_quantity(1e-5, "s"), "1e-5 s");
    EXPECT_EQ(format_quantity(-9.81, "m/s^2"), "-9.81 m/s^2");
    EXPECT_EQ(format_quantity(2e6, "MPa"), "2 MPa");
    EXPECT_EQ(format_quantity(1234.5, "mm"), "1234500 mm");
    EXPECT_EQ(format_quantity(0.0, "mm"), "0 mm");
    EXPECT_EQ(format_quantity(2.0943951023931953, "rpm"), "20 rpm");
}
