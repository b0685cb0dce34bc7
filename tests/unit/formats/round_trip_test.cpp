// Every format: what it writes is what it reads back, spheres to the precision the table states, mass properties where the format holds them.
#include <gtest/gtest.h>

#include <set>

#include "core/error.hpp"
#include "test_clump.hpp"

namespace pelletlab::shapegen::formats {
namespace {

std::vector<Format> readable() {
    std::vector<Format> formats;
    for (const Format& format : all())
        if (format.read != nullptr) formats.push_back(format);
    return formats;
}

class RoundTrip : public testing::TestWithParam<Format> {};

void expect_same(const Format& format, const ClumpTemplate& clump, const ImportedClump& read) {
    const RigidTemplate& rigid = clump.rigid;
    ASSERT_EQ(read.spheres.size(), rigid.spheres.size());
    // 4 ulp on top: the change of unit there and back.
    const double tolerance = format.precision * rigid.bounding_radius;
    for (std::size_t i = 0; i < rigid.spheres.size(); ++i) {
        EXPECT_LE((read.spheres[i].centre - rigid.spheres[i].centre).cwiseAbs().maxCoeff(), tolerance) << "sphere " << i;
        EXPECT_NEAR(read.spheres[i].radius, rigid.spheres[i].radius, tolerance) << "sphere " << i;
    }
    if (!format.holds_mass_properties) return;
    const MassProperties& mass = rigid.mass_properties;
    ASSERT_TRUE(read.mass && read.inertia && read.centre_of_mass);
    if (format.id == "mercury") {
        EXPECT_FALSE(read.volume || read.density);  // its files have no place for them
    } else {
        ASSERT_TRUE(read.volume && read.density);
        EXPECT_NEAR(*read.volume / mass.volume, 1.0, 1e-14);
        EXPECT_NEAR(*read.density / mass.density, 1.0, 1e-14);
    }
    // All digits are written; 1e-14 leaves room for powers of the unit (length^5 in PFC).
    EXPECT_NEAR(*read.mass / mass.mass, 1.0, 1e-14);
    EXPECT_EQ(read.centre_of_mass->norm(), 0.0);
    const Mat3 expected = mass.principal_inertia.asDiagonal();
    EXPECT_LE((*read.inertia - expected).cwiseAbs().maxCoeff(), 1e-14 * mass.principal_inertia.maxCoeff());
}

TEST_P(RoundTrip, UsualUnits) {
    const Format& format = GetParam();
    const ClumpTemplate clump = test_clump();
    const ReadOptions options{format.length_unit, format.mass_unit};  // the bare files of MercuryDPM do not say it
    const bool mercury = format.id == "mercury";
    expect_same(format, clump, format.read(format.write(clump, {}), mercury ? options : ReadOptions{}));
}

TEST_P(RoundTrip, OtherUnits) {
    const Format& format = GetParam();
    const ClumpTemplate clump = test_clump();
    WriteOptions options;
    options.length_unit = format.id == "lammps" ? "cm" : "um";
    options.mass_unit = "g";
    const bool mercury = format.id == "mercury";
    const ReadOptions read_options = mercury ? ReadOptions{options.length_unit, options.mass_unit} : ReadOptions{};
    expect_same(format, clump, format.read(format.write(clump, options), read_options));
}

TEST_P(RoundTrip, MainFileAloneGivesTheSpheres) {
    const Format& format = GetParam();
    const ClumpTemplate clump = test_clump(40);
    std::vector<FormatFile> files = format.write(clump, {});
    files.resize(1);
    const ReadOptions options = {format.id == "mercury" || format.id == "edem" ? format.length_unit : "", ""};
    const ImportedClump read = format.read(files, options);
    ASSERT_EQ(read.spheres.size(), 40U);
    EXPECT_LE((read.spheres[39].centre - clump.rigid.spheres[39].centre).norm(), 2.0 * std::max(format.precision, 1e-15) * clump.rigid.bounding_radius);
}

TEST_P(RoundTrip, BecomesATemplateAgain) {
    const Format& format = GetParam();
    const ClumpTemplate clump = test_clump();
    if (!format.holds_mass_properties) {
        EXPECT_THROW(rigid_template(format.read(format.write(clump, {}), {}), 1800.0), Error);
        return;
    }
    const ReadOptions options = format.id == "mercury" ? ReadOptions{format.length_unit, format.mass_unit} : ReadOptions{};
    const RigidTemplate rigid = rigid_template(format.read(format.write(clump, {}), options), format.id == "mercury" ? std::optional(1812.5) : std::nullopt);
    EXPECT_LE((rigid.mass_properties.principal_inertia - clump.rigid.mass_properties.principal_inertia).norm(), 1e-14 * 6e-11);
    EXPECT_NEAR(rigid.bounding_radius / clump.rigid.bounding_radius, 1.0, 2.0 * format.precision);
    EXPECT_NEAR(rigid.mass_properties.volume / clump.rigid.mass_properties.volume, 1.0, 1e-14);
}

TEST_P(RoundTrip, WritesTheSameBytesTwice) {
    const Format& format = GetParam();
    const std::vector<FormatFile> first = format.write(test_clump(), {}), second = format.write(test_clump(), {});
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].content, second[i].content);
}

TEST_P(RoundTrip, WritesPlainAscii) {  // LAMMPS and others stumble over anything else
    for (const FormatFile& file : GetParam().write(test_clump(), {}))
        for (const char c : file.content) ASSERT_TRUE(c == '\n' || c == '\t' || (c >= ' ' && c <= '~')) << file.name << ": " << static_cast<int>(c);
}

INSTANTIATE_TEST_SUITE_P(All, RoundTrip, testing::ValuesIn(readable()), [](const auto& test) { return test.param.id; });

TEST(FormatTable, IdsAndExtensionsAreUniqueAndDescribed) {
    std::set<std::string> ids, extensions;
    for (const Format& format : all()) {
        EXPECT_TRUE(ids.insert(format.id).second) << format.id;
        EXPECT_TRUE(extensions.insert(format.extension).second) << format.extension;
        EXPECT_FALSE(format.description.empty() || format.documented_in.empty() || format.program.empty()) << format.id;
        EXPECT_NE(format.write, nullptr);
        const std::vector<FormatFile> files = format.write(dumbbell(), {});
        const std::string name = files.front().name;
        EXPECT_EQ(name.substr(name.size() - format.extension.size()), format.extension);
        EXPECT_EQ(name.rfind("dumbbell", 0), 0U);
    }
    EXPECT_EQ(ids, (std::set<std::string>{"liggghts", "lammps", "yade", "mercury", "chrono", "pfc", "edem", "csv", "vtk", "stl"}));
}

TEST(FormatTable, SuggestsTheFormatMeant) {
    EXPECT_EQ(find("liggghts").id, "liggghts");
    try {
        find("ligghts");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(error.remedy().find("'liggghts'"), std::string::npos) << error.remedy();
    }
}

// The text itself, against what the programs' documentation shows: a wrong order of numbers would survive any round trip.
TEST(Text, Liggghts) {
    const std::vector<FormatFile> files = find("liggghts").write(dumbbell(), {});
    EXPECT_EQ(files[0].content.substr(files[0].content.find("\n-") + 1), "-0.5 0 0 1\n0.5 0.25 0 1.5\n");
    EXPECT_NE(files[1].content.find(
                  "fix pts_dumbbell all particletemplate/multisphere 15485863 atom_type 1 density constant 2000 nspheres 2 ntry 100000 spheres file "
                  "dumbbell.liggghts.txt scale 0.001 type 1 mass 4e-05 inertia_tensor 3e-11 0 0 5e-11 0 6e-11 use_density\n"),
              std::string::npos)
        << files[1].content;
}

TEST(Text, Lammps) {
    WriteOptions cgs;
    cgs.length_unit = "cm";
    cgs.mass_unit = "g";
    const std::vector<FormatFile> files = find("lammps").write(dumbbell(), cgs);
    const std::string& text = files[0].content;
    EXPECT_NE(text.find("\n2 atoms\n0.04 mass\n0 0 0 com\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\nCoords\n\n1 -0.05 0 0\n2 0.05 0.025 0\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\nDiameters\n\n1 0.2\n2 0.3\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\nMasses\n\n1 0.02\n2 0.02\n"), std::string::npos) << text;
    EXPECT_EQ(files[1].content.find("WARNING"), std::string::npos);                                           // 3e-4 g cm²
    EXPECT_NE(find("lammps").write(dumbbell(), {})[1].content.find("LAMMPS issue 1657"), std::string::npos);  // 3e-11 kg m²
}

TEST(Text, Pfc) {
    const std::string text = find("pfc").write(dumbbell(), {})[0].content;
    EXPECT_NE(text.find("    pebbles 2 ...\n        0.001 (-5e-04,0,0) ...\n        0.0015 (5e-04,0.00025,0)\n"), std::string::npos) << text;
    EXPECT_NE(text.find("    volume 2e-08 ...\n    inertia 1.5e-14 2.5e-14 3e-14 0 0 0 ...\n"), std::string::npos) << text;  // I / density
    EXPECT_NE(text.find("clump attribute density 2000\n"), std::string::npos) << text;
}

TEST(Text, ChronoAvoidsExponents) {
    const std::string text = find("chrono").write(dumbbell(), {})[0].content;
    EXPECT_EQ(text.substr(0, text.find('#')), "x,y,z,r\n-0.0005,0,0,0.001\n0.0005,0.00025,0,0.0015\n");
}

TEST(Text, MercuryHasNoCommentsAndNothingBelowSinglePrecision) {
    ClumpTemplate clump = dumbbell();
    clump.rigid.spheres[0].centre.y() = 1e-60;  // std::stof of MercuryDPM would throw out_of_range
    const std::vector<FormatFile> files = find("mercury").write(clump, {});
    ASSERT_EQ(files.size(), 4U);
    EXPECT_EQ(files[0].content, "-5e-04,0,0,0.001\n5e-04,0.00025,0,0.0015\n");
    EXPECT_EQ(files[1].content, "4e-05\n");
    EXPECT_EQ(files[2].content, "3e-11,0,0\n0,5e-11,0\n0,0,6e-11\n");
    EXPECT_EQ(files[3].content, "1,0,0\n0,1,0\n0,0,1\n");
}

TEST(Text, CsvAndEdemNameTheirUnit) {
    EXPECT_EQ(find("csv").write(dumbbell(), {})[0].content, "x [mm],y [mm],z [mm],radius [mm]\n-0.5,0,0,1\n0.5,0.25,0,1.5\n");
    const std::string edem = find("edem").write(dumbbell(), {})[0].content;
    EXPECT_EQ(edem.substr(edem.find("\nsphere 1") + 1), "sphere 1\t1.5\t1.5\t0.5\t0.25\t0\n");
}

}  // namespace
}  // namespace pelletlab::shapegen::formats
