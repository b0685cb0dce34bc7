#include "io/observables_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using pelletlab::test::bits;
using pelletlab::test::error_of;
using testing::HasSubstr;

namespace {

Observables sample() {
    Observables o;
    o.case_name = "tube \"µ\"";
    o.status = "not at rest";
    o.values = {{"bed_height_h95", "mm", 1.0 / 3.0, not_known, {0.1, 0.2}, "tube.h95"}, {"packing_fraction", "1", 0.1 + 0.2, 5e-324, {0.0, 1e300}, "tube.phi"}};
    o.profiles = {{"porosity", "1", "distance_from_wall", "mm", {0.5, 1.5, 2.5}, {0.4, not_known, 0.3}, {not_known, 0.1, 0.2}, {0.0, 1.0}, "tube.porosity"},
                  {"empty", "1", "r", "mm", {}, {}, {}, {}, "none"}};
    o.maps = {
        {"speed", "m/s", "x", "z", -0.04, -0.03, 0.002, 2, 3, {1.0, 2.0, not_known, 4.0, 5.0, 1.0 / 7.0}, {1, 2, 0, 4, 5, 6}, {1.0, 2.0}, "drum.velocity"}};
    o.provenance = {"pelletlab", "0.1.0", "abc", "fill", 18446744073709551615ull, {{"a.toml", "00"}}};
    return o;
}

bool same(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || bits(a) == bits(b);
}
bool same(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return same(x, y); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST(ObservablesFile, ComesBackBitForBit) {
    const test::TemporaryFolder folder;
    const Observables a = sample();
    io::write_observables(a, folder / "observables.json");
    const Observables b = io::read_observables(folder / "observables.json");
    EXPECT_EQ(b.case_name, a.case_name);
    EXPECT_EQ(b.status, a.status);
    ASSERT_EQ(b.values.size(), a.values.size());
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        EXPECT_EQ(b.values[i].name, a.values[i].name);
        EXPECT_EQ(b.values[i].unit, a.values[i].unit);
        EXPECT_EQ(b.values[i].method, a.values[i].method);
        EXPECT_TRUE(same(b.values[i].value, a.values[i].value));
        EXPECT_TRUE(same(b.values[i].standard_error, a.values[i].standard_error));
        EXPECT_EQ(b.values[i].window.begin, a.values[i].window.begin);
        EXPECT_EQ(b.values[i].window.end, a.values[i].window.end);
    }
    ASSERT_EQ(b.profiles.size(), a.profiles.size());
    EXPECT_EQ(b.profiles[0].axis_name, "distance_from_wall");
    EXPECT_TRUE(same(b.profiles[0].axis, a.profiles[0].axis));
    EXPECT_TRUE(same(b.profiles[0].value, a.profiles[0].value));
    EXPECT_TRUE(same(b.profiles[0].standard_error, a.profiles[0].standard_error));
    ASSERT_EQ(b.maps.size(), 1u);
    EXPECT_EQ(b.maps[0].columns, 2u);
    EXPECT_EQ(b.maps[0].rows, 3u);
    EXPECT_EQ(b.maps[0].spacing, a.maps[0].spacing);
    EXPECT_EQ(b.maps[0].origin_horizontal, a.maps[0].origin_horizontal);
    EXPECT_EQ(b.maps[0].origin_vertical, a.maps[0].origin_vertical);
    EXPECT_TRUE(same(b.maps[0].value, a.maps[0].value));
    EXPECT_TRUE(same(b.maps[0].sample_count, a.maps[0].sample_count));
    EXPECT_EQ(b.provenance.seed, a.provenance.seed);
    EXPECT_EQ(b.provenance.input_hashes, a.provenance.input_hashes);
    EXPECT_EQ(io::observables_text(b), io::observables_text(a));
}

TEST(ObservablesFile, NanIsNullAndInfinityIsRefused) {
    EXPECT_THAT(io::observables_text(sample()), HasSubstr("\"standard_error\": null"));
    Observables o = sample();
    o.values[0].value = std::numeric_limits<double>::infinity();
    const Error error = error_of([&] { io::observables_text(o); });
    EXPECT_EQ(error.kind(), ErrorKind::numerical);
    EXPECT_THAT(error.what(), HasSubstr("bed_height_h95 is infinite"));
}

TEST(ObservablesFile, MistakesAreTold) {
    const std::string good = io::observables_text(sample());
    const auto message = [&](const std::string& from, const std::string& to) {
        return std::string(error_of([&] { io::parse_observables(replaced(good, from, to), "o.json"); }).what());
    };
    EXPECT_THAT(message("pelletlab-observables", "other"), HasSubstr("not an observables file"));
    EXPECT_THAT(message("\"format_version\": 1", "\"format_version\": 2"), HasSubstr("format version"));
    EXPECT_THAT(message("\"case_name\"", "\"case_nam\""), HasSubstr("has no member 'case_name'"));
    EXPECT_THAT(message("\"values\": [\n  {\n", "\"values\": [\n  {\n   \"unti\": 1,\n"),
                HasSubstr("/values/0 has an unknown member 'unti'\n  what to do: did you mean 'unit'?"));
    EXPECT_THAT(message("\"unit\": \"mm\"", "\"unit\": 5"), HasSubstr("/values/0 member 'unit' is not a text"));
    EXPECT_THAT(message("\"columns\": 2", "\"columns\": -2"), HasSubstr("whole number"));
    EXPECT_THAT(message("\"columns\": 2", "\"columns\": 4"), HasSubstr("/maps/0 has lists that do not fit"));
    EXPECT_THAT(message("\"columns\": 2", "\"columns\": 0"), HasSubstr("/maps/0 has lists that do not fit"));
    EXPECT_THAT(message("0.3333333333333333", "\"x\""), HasSubstr("member 'value' is not a number or null"));
    EXPECT_THAT(message("\"values\": [", "\"values\": [5, "), HasSubstr("/values/0 is not an object"));
    EXPECT_THAT(error_of([&] { io::parse_observables("[]", "o.json"); }).what(), HasSubstr("is not an object"));
}

TEST(ObservablesFile, BrokenJsonIsToldWithItsPlace) {
    const Error error = error_of([] { io::parse_observables("{\n  \"a\": 1,\n  \"b\" 2\n}\n", "o.json"); });
    EXPECT_EQ(error.place().line, 3);
    EXPECT_EQ(error.place().column, 7);
    EXPECT_EQ(error_of([] { io::parse_observables("", "o.json"); }).place().line, 1);
    EXPECT_THROW(io::parse_observables(io::observables_text(sample()).substr(0, 300), "o.json"), Error);
}
