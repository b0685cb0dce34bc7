// Wrong input: one clear error each, with file, line and column where a file is wrong.
#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "test_clump.hpp"

namespace pelletlab::shapegen::formats {
namespace {

struct BadFile {
    const char* what;
    const char* format;
    const char* text;
    int line, column;
    const char* says;  ///< part of the message
    const char* companion = nullptr;
};

const BadFile bad_files[] = {
    {"LetterInNumber", "liggghts", "0 0 0 1\n0 0.5x 0 1\n", 2, 3, "'0.5x'"},
    {"ThreeNumbers", "liggghts", "# two spheres\n1 2 3\n", 2, 5, "four numbers"},
    {"NegativeRadius", "liggghts", "0 0 0 -1\n", 1, 7, "greater than zero"},
    {"NotANumber", "liggghts", "0 nan 0 1\n", 1, 3, "not a finite number"},
    {"Infinite", "liggghts", "0 0 1e999 1\n", 1, 5, "not a finite number"},
    {"EmptyFile", "liggghts", "", 0, 0, "no spheres"},
    {"OnlyComments", "liggghts", "# nothing\n\n", 0, 0, "no spheres"},
    {"EndsContinued", "liggghts", "0 0 0 &\n", 1, 5, "continued"},
    {"NoCommand", "liggghts", "0 0 0 1\n0 0 1 1\n", 0, 0, "no 'fix", "# nothing\n"},
    {"InertiaCutShort", "liggghts", "0 0 0 1\n0 0 1 1\n", 1, 61, "needs 6 value(s)",
     "fix p all particletemplate/multisphere 1 mass 1 use_density inertia_tensor 1 0 0\n"},
    {"NoAtoms", "lammps", "# x\n\nCoords\n\n1 0 0 0\n", 3, 1, "no line 'N atoms'"},
    {"AtomTwice", "lammps", "# x\n2 atoms\n\nCoords\n\n1 0 0 0\n1 0 0 1\n", 7, 1, "twice"},
    {"AtomOutOfRange", "lammps", "# x\n2 atoms\n\nCoords\n\n1 0 0 0\n3 0 0 1\n", 7, 1, "from 1 to 2"},
    {"FewerRowsThanAtoms", "lammps", "# x\n900000 atoms\n\nCoords\n\n1 0 0 0\n", 6, 1, "row(s) early"},
    {"UnknownSection", "lammps", "# x\n1 atoms\n\nBonds\n\n1 1 1 2\n", 4, 1, "'Bonds'"},
    {"NoDiameters", "lammps", "# x\n1 atoms\n\nCoords\n\n1 0 0 0\n", 0, 0, "no section Diameters"},
    {"InertiaNotOfABody", "lammps", "# x\n1 atoms\n1 mass\n0 0 0 com\n1 1 -1 0 0 0 inertia\n\nCoords\n\n1 0 0 0\n\nDiameters\n\n1 1\n", 0, 0,
     "principal moments"},
    {"TwoClumps", "yade", "#format x_y_z_r_clumpId\n0 0 0 1 7\n0 0 1 1 8\n", 3, 9, "more than one clump"},
    {"UnknownColumns", "yade", "#format x_y_z\n0 0 0\n", 1, 9, "'x_y_z'"},
    {"MissingColumn", "yade", "#format x_y_z_r_matId\n0 0 0 1\n", 2, 7, "needs 5 values"},
    {"FiveNumbers", "mercury", "0,0,0,1\n0,0,0,1,2\n", 2, 9, "four numbers"},
    {"EmptyCell", "mercury", "0,,0,1\n", 1, 3, "y coordinate"},
    {"NoHeader", "chrono", "0,0,0,1\n", 1, 1, "header x,y,z,r"},
    {"ColumnMissing", "chrono", "x,y,r\n0,0,1\n", 1, 1, "no column z"},
    {"ShortRow", "chrono", "x,y,z,r\n0,0,0,1\n0,0,0\n", 3, 5, "3 cell(s)"},
    {"NotPfc", "pfc", "; just a comment\nball create\n", 0, 0, "clump template create"},
    {"PebblesCutShort", "pfc", "clump template create name 'a' ...\n pebbles 2 1 (0,0,0)\n", 2, 19, "ends after the keyword 'pebbles'"},
    {"UnknownKeyword", "pfc", "clump template create geometry 'rock'\n", 1, 23, "'geometry'"},
    {"SecondClump", "pfc", "clump create pebbles 1 1 0 0 0\nclump create pebbles 1 1 0 0 0\n", 2, 1, "second clump"},
    {"TooManyPebbles", "pfc", "clump create pebbles 99999999999 1 0 0 0\n", 1, 22, "from 1 to 1000000"},
    {"ColumnTwice", "csv", "x,y,z,r,radius\n0,0,0,1,1\n", 1, 9, "twice"},
    {"MixedUnits", "csv", "x [mm],y [mm],z [m],r [mm]\n0,0,0,1\n", 1, 15, "different units"},
    {"BracketOpen", "csv", "x [mm,y,z,r\n0,0,0,1\n", 1, 1, "bracket"},
    {"UnknownQuantity", "csv", "x [mm],y [mm],z [mm],r [mm]\n0,0,0,1\n", 2, 1, "'weight'", "quantity,value,unit\nweight,1,kg\n"},
    {"MassInMillimetres", "csv", "x [mm],y [mm],z [mm],r [mm]\n0,0,0,1\n", 2, 8, "mass", "quantity,value,unit\nmass,1,mm\n"},
    {"Binary", "vtk", "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\n", 3, 1, "only ASCII"},
    {"NotVtk", "vtk", "solid x\nfacet normal 0 0 0\n\n\n", 1, 1, "not a legacy VTK"},
    {"NoRadius", "vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 double\n0 0 0\n", 0, 0, "no array 'radius'"},
    {"PointsCutShort", "vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 500000 double\n0 0 0 1\n", 6, 1, "ends where a coordinate"},
    {"RadiiMissing", "vtk",
     "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 0 0 1 1 1\nPOINT_DATA 1\nSCALARS radius double\nLOOKUP_TABLE default\n1\n", 0,
     0, "2 points but 1 radii"},
};

class Bad : public testing::TestWithParam<BadFile> {};

TEST_P(Bad, NamesFileLineAndColumn) {
    const BadFile& bad = GetParam();
    std::vector<FormatFile> files{{"main.file", bad.text}};
    if (bad.companion != nullptr) files.push_back({"companion.file", bad.companion});
    const std::string at = bad.companion != nullptr && bad.line > 0 ? "companion.file" : "main.file";
    try {
        find(bad.format).read(files, {"mm", "kg"});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        EXPECT_NE(error.problem().find(bad.says), std::string::npos) << error.problem();
        EXPECT_EQ(error.place().file, bad.line > 0 ? at : error.place().file);
        EXPECT_FALSE(error.place().file.empty());
        EXPECT_EQ(error.place().line, bad.line) << error.problem();
        EXPECT_EQ(error.place().column, bad.column) << error.problem();
    }
}

INSTANTIATE_TEST_SUITE_P(Files, Bad, testing::ValuesIn(bad_files), [](const auto& test) { return std::string(test.param.format) + test.param.what; });

std::string problem_of(const auto& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.problem();
    }
    return "no error";
}

TEST(Units, AreAskedForWhenTheFileDoesNotSayThem) {
    for (const char* id : {"liggghts", "yade", "mercury", "csv"}) {
        const FormatFile file{"f", id == std::string("mercury") || id == std::string("csv") ? "0,0,0,1\n" : "0 0 0 1\n"};
        EXPECT_NE(problem_of([&] { find(id).read({file}, {}); }).find("does not say in which unit its length is"), std::string::npos) << id;
        EXPECT_EQ(find(id).read({file}, {"mm", ""}).spheres[0].radius, 0.001) << id;
    }
}

TEST(Units, MustAgreeWithTheFile) {
    const std::vector<FormatFile> files = find("liggghts").write(dumbbell(), {});  // in mm
    EXPECT_NO_THROW(find("liggghts").read(files, {"mm", ""}));
    EXPECT_NE(problem_of([&] { find("liggghts").read(files, {"cm", ""}); }).find("the file says its length is in 'mm'"), std::string::npos);
}

TEST(Units, AnUnknownOneInTheFileNamesTheFile) {
    try {
        find("liggghts").read({{"pellet.txt", "# PelletLab clump: name a, length in mmm, mass in kg\n0 0 0 1\n"}}, {});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.place().file, "pellet.txt");
        EXPECT_NE(error.problem().find("mmm"), std::string::npos) << error.problem();
    }
}

TEST(Units, UnknownOnesAreRefused) {
    EXPECT_NE(problem_of([] { find("csv").read({{"f", "x [furlong],y,z,r\n0,0,0,1\n"}}, {}); }).find("furlong"), std::string::npos);
    WriteOptions options;
    options.length_unit = "parsec";
    EXPECT_NE(problem_of([&] { find("csv").write(dumbbell(), options); }).find("parsec"), std::string::npos);
}

TEST(Writers, RefuseWhatTheProgramCannotTake) {
    ClumpTemplate one = dumbbell();
    one.rigid.spheres.resize(1);
    EXPECT_NE(problem_of([&] { find("liggghts").write(one, {}); }).find("one sphere"), std::string::npos);
    EXPECT_NO_THROW(find("lammps").write(one, {}));
    WriteOptions millimetres;
    millimetres.length_unit = "mm";
    EXPECT_NE(problem_of([&] { find("lammps").write(dumbbell(), millimetres); }).find("no unit system"), std::string::npos);
    ClumpTemplate tiny = dumbbell();
    tiny.rigid.mass_properties.principal_inertia *= 1e-30;
    EXPECT_NE(problem_of([&] { find("mercury").write(tiny, {}); }).find("single precision"), std::string::npos);
    ClumpTemplate sliver = dumbbell();
    sliver.rigid.spheres[0].radius = 1e-11;  // would be printed as 0 (found by the fuzzer)
    EXPECT_NE(problem_of([&] { find("chrono").write(sliver, {}); }).find("1e-7 of the clump"), std::string::npos);
}

TEST(Writers, RefuseIncompleteClumps) {
    for (const Format& format : all()) {
        ClumpTemplate clump = dumbbell();
        clump.rigid.spheres.clear();
        EXPECT_NE(problem_of([&] { format.write(clump, {}); }).find("no spheres"), std::string::npos) << format.id;
        clump = dumbbell();
        clump.rigid.spheres[1].radius = 0.0;
        EXPECT_NE(problem_of([&] { format.write(clump, {}); }).find("positive radius"), std::string::npos) << format.id;
        clump = dumbbell();
        clump.rigid.mass_properties.mass = std::numeric_limits<double>::quiet_NaN();
        EXPECT_NE(problem_of([&] { format.write(clump, {}); }).find("lacks a positive mass"), std::string::npos) << format.id;
    }
}

TEST(Writers, MakeSafeNames) {
    ClumpTemplate clump = dumbbell();
    clump.rigid.name = "../../étrange 'name'; rm -rf";
    for (const Format& format : all())
        for (const FormatFile& file : format.write(clump, {})) {
            EXPECT_EQ(file.name.rfind("trange_name_rm_rf", 0), 0U) << file.name;
            EXPECT_EQ(file.content.find("rm -rf"), std::string::npos) << file.name;
        }
    clump.rigid.name = "…";
    EXPECT_EQ(find("csv").write(clump, {})[0].name, "pellet.csv");
    clump.rigid.name = "3mm";
    EXPECT_EQ(find("csv").write(clump, {})[0].name, "pellet_3mm.csv");
}

TEST(Template, SaysWhatIsMissing) {
    ImportedClump clump;
    clump.spheres = dumbbell().rigid.spheres;
    EXPECT_NE(problem_of([&] { rigid_template(clump); }).find("no mass"), std::string::npos);
    clump.mass = 1e-5;
    EXPECT_NE(problem_of([&] { rigid_template(clump); }).find("no inertia"), std::string::npos);
    clump.inertia = Mat3(Mat3::Identity() * 1e-11);
    EXPECT_NE(problem_of([&] { rigid_template(clump); }).find("neither volume nor density"), std::string::npos);
    EXPECT_NEAR(rigid_template(clump, 2000.0).mass_properties.volume, 5e-9, 1e-24);
}

TEST(Template, TurnsIntoThePrincipalFrame) {
    const Pose pose{Vec3(0.003, -0.001, 0.002), Quat(0.8, 0.2, -0.3, 0.4).normalized()};
    const RigidTemplate original = test_clump().rigid;
    ImportedClump clump;
    clump.name = "turned";
    for (const Sphere& s : original.spheres) clump.spheres.push_back({pose.to_world(s.centre), s.radius});
    const Mat3 turn = pose.orientation.toRotationMatrix();
    clump.mass = original.mass_properties.mass;
    clump.volume = original.mass_properties.volume;
    clump.inertia = Mat3(turn * original.mass_properties.principal_inertia.asDiagonal() * turn.transpose());
    clump.centre_of_mass = pose.position;
    const RigidTemplate rigid = rigid_template(clump);
    // Moments come in ascending order, as the test clump has them; axes may be reversed in pairs, so compare distances from the three planes.
    EXPECT_LE((rigid.mass_properties.principal_inertia - original.mass_properties.principal_inertia).norm(), 1e-12 * 6e-11);
    for (std::size_t i = 0; i < original.spheres.size(); ++i)
        EXPECT_LE((rigid.spheres[i].centre.cwiseAbs() - original.spheres[i].centre.cwiseAbs()).norm(), 1e-12) << i;  // 1 pm: eigenvectors are good to 1e-13
    EXPECT_NEAR(rigid.bounding_radius, original.bounding_radius, 1e-15);
    const Mat3 axes = rigid.mass_properties.principal_axes.toRotationMatrix();
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
    EXPECT_LE((axes * rigid.spheres[0].centre + rigid.mass_properties.centre_of_mass_mesh - clump.spheres[0].centre).norm(), 1e-15);
}

}  // namespace
}  // namespace pelletlab::shapegen::formats
