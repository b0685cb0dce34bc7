// Every kind of mistake in a case file, with its exact place and its remedy.
#include <gmock/gmock.h>

#include "io/case_file.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using pelletlab::test::error_of;
using testing::HasSubstr;

namespace {

struct Mistake {
    const char* name;
    const char* text;
    int line, column;  // of the error; 0, 0: the file alone
    const char* problem;
    const char* remedy;
};

void PrintTo(const Mistake& mistake, std::ostream* stream) {
    *stream << mistake.name;
}

class CaseMistakes : public testing::TestWithParam<Mistake> {};

const Mistake mistakes[] = {
    {"Syntax", "seed = 1\nname = \"tube\nrig = \"tube\"\n", 2, 13, "this is no TOML", "correct the text"},
    {"CommentInATablesHead", "[ # inner\n", 1, 3, "this is no TOML", "correct the text"},  // found by fuzzing: an assertion of toml++
    {"DuplicateKey", "seed = 1\nseed = 2\n", 2, 8, "this is no TOML", "correct the text"},
    {"UnknownKey", "[tube]\n  diametre = \"52 mm\"\n", 2, 3, "unknown key 'tube.diametre'", "did you mean 'tube.diameter'?"},
    {"UnknownTopKey", "sead = 1\n", 1, 1, "unknown key 'sead'", "did you mean 'seed'?"},
    {"UnknownTable", "[drumm]\nspeed = \"2 rpm\"\n", 1, 2, "unknown key 'drumm'", "did you mean 'drum'?"},
    {"KeyOfAnotherTable", "frame_interval = \"1 ms\"\n", 1, 1, "unknown key 'frame_interval'", "output.frame_interval"},
    {"KeyOfNoTable", "[tube]\nxyzzy_plugh = 1\n", 2, 1, "unknown key 'tube.xyzzy_plugh'", "case reference"},
    {"UnknownMaterialKey", "[materials.pellet]\nyoungs_modulus = \"2 MPa\"\nshear_moduls = 1\n", 2, 1, "unknown key 'materials.pellet.youngs_modulus'",
     "case reference"},
    {"FirstInTheFile", "zzz = 1\n[tube]\naaa = 1\n", 1, 1, "unknown key 'zzz'", ""},
    {"ArrayOfTables", "[[tube]]\n", 1, 3, "tube is a table of keys, and this is a list", "[tube]"},
    {"TableForKey", "[tube]\ndiameter.inner = \"2 mm\"\n", 2, 1, "must be a text with number and unit, and this is a table", "diameter = \"52 mm\""},
    {"KeyForTable", "drum = 3\n", 1, 1, "drum is a table of keys, and this is a whole number", "[drum]"},
    {"BareNumber", "[tube]\ndiameter = 52\n", 2, 12, "tube.diameter is a bare number without a unit", "diameter = \"52 mm\""},
    {"BareFloat", "[time]\nstep = 1e-5\n", 2, 8, "time.step is a bare number without a unit", "s, ms, us"},
    {"NoUnit", "[tube]\ndiameter = \"52\"\n", 2, 12, "tube.diameter: '52' has no unit", "mm"},
    {"WrongUnit", "[tube]\ndiameter = \"52 s\"\n", 2, 12, "'s' is a unit of time", "mm"},
    {"UnknownUnit", "[drum]\nspeed = \"20 rmp\"\n", 2, 9, "unknown unit 'rmp'", "rpm"},
    {"NotANumber", "[drum]\nspeed = \"fast rpm\"\n", 2, 9, "does not begin with a number", "rpm"},
    {"WrongType", "[pellet]\ncount = \"1000\"\n", 2, 9, "pellet.count must be a whole number, and this is a text", "count = 1000"},
    {"FloatForWhole", "[pellet]\ncount = 1000.0\n", 2, 9, "pellet.count must be a whole number, and this is a number", "count = 1000"},
    {"TextForFlag", "[output]\nparaview = \"yes\"\n", 2, 12, "output.paraview must be true or false, and this is a text", "paraview = true"},
    {"NumberForText", "name = 5\n", 1, 8, "name must be a text, and this is a whole number", "name = \"tube\""},
    {"DateForNumber", "[contacts.pellet-pellet]\nrestitution = 2020-01-01\n", 2, 15, "must be a number, and this is a date", "restitution = 0.4"},
    {"WallOfNoShape", "[walls.ramp]\npoint = [\"0 mm\", \"0 mm\", \"1 mm\"]\n", 1, 8, "walls.ramp has no shape", "write for instance shape = \"plane\""},
    {"WallShape", "[walls.ramp]\nshape = \"cylindre\"\n", 2, 9, "walls.ramp.shape = \"cylindre\" is not known", "did you mean \"cylinder\"?"},
    {"WallAxisWithUnit", "[walls.ramp]\nshape = \"plane\"\naxis = [\"1 mm\", 0, 0]\n", 3, 9, "walls.ramp.axis", ""},
    {"WallAxisOfNoLength", "[walls.ramp]\nshape = \"plane\"\npoint = [\"0 mm\", \"0 mm\", \"1 mm\"]\naxis = [0, 0, 0]\n", 4, 8,
     "walls.ramp: its axis has no direction", "axis = [0, 0, 1]"},
    {"WallRadius", "[walls.pin]\nshape = \"cylinder\"\npoint = [\"0 mm\", \"0 mm\", \"1 mm\"]\nlength = \"5 mm\"\n", 1, 8,
     "walls.pin: a cylinder needs a radius", "radius = \"10 mm\""},
    {"WallThatTurnsInATube", "[walls.pin]\nshape = \"plane\"\npoint = [\"0 mm\", \"0 mm\", \"1 mm\"]\nturns = true\n", 4, 9,
     "walls.pin: only a drum or a tester turns", "remove turns"},
    {"WallNameTaken", "[walls.floor]\nshape = \"plane\"\npoint = [\"0 mm\", \"0 mm\", \"1 mm\"]\n", 1, 8, "the rig itself has a wall of this name",
     "another name"},
    {"WallMaterial", "[walls.pin]\nshape = \"plane\"\npoint = [\"0 mm\", \"0 mm\", \"1 mm\"]\nmaterial = \"vesel\"\n", 4, 12,
     "the material 'vesel' is not defined", "did you mean 'vessel'?"},
    {"ExactAndMesh", "[tube]\nsurface = \"exact\"\nmesh_file = \"a.stl\"\nmesh_unit = \"mm\"\n", 2, 11, "tube.mesh_file asks for another vessel",
     "remove one of the two"},
    {"AirViscosity", "[physics]\nair_viscosity = \"18 Pa\"\n", 2, 17, "'Pa' is a unit of pressure", "Pa*s"},
    {"Choice", "rig = \"drom\"\n", 1, 7, "rig = \"drom\" is not known", "did you mean \"drum\"? allowed: \"tube\", \"drum\""},
    {"VectorLength", "gravity = [\"0 m/s^2\", \"-9.81 m/s^2\"]\n", 1, 11, "gravity needs three values, and there are 2", "gravity = ["},
    {"VectorElement", "gravity = [\"0 m/s^2\", \"0 m/s^2\", -9.81]\n", 1, 34, "gravity is a bare number without a unit", "m/s^2"},
    {"VectorType", "gravity = \"-9.81 m/s^2\"\n", 1, 11, "gravity must be a list of three texts", "gravity = ["},
    {"Negative", "[tube]\ndiameter = \"-52 mm\"\n", 2, 12, "tube.diameter = -52 mm is out of range", "> 0 mm"},
    {"Zero", "[time]\nstep = \"0 s\"\n", 2, 8, "time.step = 0 s is out of range", "> 0 s and ≤ 0.1 s"},
    {"NegativeCount", "[pellet]\ncount = -1\n", 2, 9, "pellet.count = -1 is out of range", "0 to 1e8"},
    {"TooFewFacets", "[drum]\nfacets = 3\n", 2, 10, "drum.facets = 3 is out of range", "8 to 4096"},
    {"Restitution0", "[contacts.pellet-pellet]\nrestitution = 0\n", 2, 15, "restitution = 0 is out of range", "> 0 and ≤ 1"},
    {"Restitution2", "[contacts.pellet-vessel]\nrestitution = 1.1\n", 2, 15, "restitution = 1.1 is out of range", "> 0 and ≤ 1"},
    {"Poisson", "[materials.pellet]\npoisson_ratio = 0.5\n", 2, 17, "poisson_ratio = 0.5 is out of range", "> -1 and < 0.5"},
    {"PoissonLow", "[materials.pellet]\npoisson_ratio = -1.0\n", 2, 17, "poisson_ratio = -1 is out of range", "> -1 and < 0.5"},
    {"Friction", "[contacts.pellet-pellet]\nsliding_friction = -0.1\n", 2, 20, "sliding_friction = -0.1 is out of range", "≥ 0"},
    {"Nan", "[contacts.pellet-pellet]\nsliding_friction = nan\n", 2, 20, "sliding_friction = nan is out of range", "≥ 0"},
    {"Infinite", "[contacts.pellet-pellet]\nrolling_friction = inf\n", 2, 20, "rolling_friction = inf is out of range", "≥ 0"},
    {"SeedTooLarge", "seed = 9223372036854775807\n", 1, 8, "is out of range", "0 to"},
    {"UndefinedMaterial", "[pellet]\nmaterial = \"vesel\"\n", 2, 12, "pellet.material: the material 'vesel' is not defined",
     "did you mean 'vessel'? add a table [materials.vesel]"},
    {"UndefinedWallMaterial", "rig = \"drum\"\n[drum]\nmaterial = \"glass\"\n", 3, 12, "drum.material: the material 'glass' is not defined",
     "[materials.glass]"},
    {"IncompleteMaterial", "[materials.glass]\ndensity = \"2500 kg/m^3\"\npoisson_ratio = 0.2\n", 1, 12, "materials.glass has no shear_modulus",
     "shear_modulus = \"2 MPa\""},
    {"IncompleteContact", "[contacts.pellet-floor]\nrestitution = 0.5\n", 1, 11, "contacts.pellet-floor has no sliding_friction", "sliding_friction = 0.7"},
    {"ContactOfNobody", "[contacts.pellet-flor]\nrestitution = 0.5\nsliding_friction = 0.5\nrolling_friction = 0\n", 1, 11,
     "its partner is no wall and no defined material", "did you mean 'pellet-floor'?"},
    {"ContactOfTheOtherRig", "rig = \"drum\"\n[contacts.pellet-floor]\nrestitution = 0.5\nsliding_friction = 0.5\nrolling_friction = 0\n", 2, 11,
     "is no wall", "'shell'"},
    {"MissingContactRow", "[tube]\nmaterial = \"glass\"\n[materials.glass]\ndensity = \"2500 kg/m^3\"\npoisson_ratio = 0.2\nshear_modulus = \"1 GPa\"\n", 2, 12,
     "the wall 'shell' has no contact row with the pellets", "[contacts.pellet-glass]"},
    {"EmptyName", "name = \"\"\n", 1, 8, "name is empty", "give the run a name"},
    {"ZeroGravity", "gravity = [\"0 m/s^2\", \"0 m/s^2\", \"0 m/s^2\"]\n", 1, 11, "gravity is zero", "-9.81"},
    {"NoClump", "[pellet]\nclump_file = \"\"\n", 2, 14, "clump_file is empty", "pelletlab shape"},
    {"NoPelletsInATube", "[pellet]\ncount = 0\n", 2, 9, "only a drum has a fill fraction", "state the number"},
    {"MeshWithoutUnit", "[tube]\nmesh_file = \"a.stl\"\n", 2, 13, "tube.mesh_file has no unit", "mesh_unit = \"mm\""},
    {"MeshUnit", "rig = \"drum\"\n[drum]\nmesh_file = \"a.stl\"\nmesh_unit = \"kg\"\n", 4, 13, "drum.mesh_unit: 'kg' is a unit of mass", "mm"},
    {"FramesCloserThanSteps", "[output]\nframe_interval = \"1 us\"\n", 2, 18, "time.step is longer than output.frame_interval", "shorten the step"},
    {"NoFrameMeasured", "rig = \"drum\"\n[time]\nmeasure = \"1 ms\"\n", 3, 11, "no frame would be measured", "measure longer"},
    {"CoarseGrid", "[measurement]\nheight_grid = \"60 mm\"\n", 2, 15, "larger than the tube's diameter", "finer"},
    {"DeepKey", "\n", 0, 0, "", ""},  // text is made below
};

}  // namespace

TEST_P(CaseMistakes, AreToldWithPlaceAndRemedy) {
    const Mistake& mistake = GetParam();
    std::string text = mistake.text;
    if (std::string(mistake.name) == "DeepKey") {
        text = "seed = 1\na";
        for (int i = 0; i < 100000; ++i) text += ".a";  // toml++ alone overflows the stack on this
        const Error error = error_of([&] { io::parse_case(text + " = 1\n", "my.toml"); });
        EXPECT_THAT(error.what(), HasSubstr("my.toml:2: a key has more than 64 parts"));
        return;
    }
    const Error error = error_of([&] { io::parse_case(text, "my.toml"); });
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.exit_code(), 3);
    EXPECT_EQ(error.place().file, "my.toml");
    EXPECT_EQ(error.place().line, mistake.line) << error.what();
    EXPECT_EQ(error.place().column, mistake.column) << error.what();
    EXPECT_THAT(error.problem(), HasSubstr(mistake.problem));
    EXPECT_THAT(error.remedy(), HasSubstr(mistake.remedy));
}

INSTANTIATE_TEST_SUITE_P(All, CaseMistakes, testing::ValuesIn(mistakes), [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(CaseErrors, ReadAsOneLineWithThePlaceInFront) {
    const Error error = error_of([] { io::parse_case("[tube]\ndiametre = 1\n", "my.toml"); });
    EXPECT_STREQ(error.what(), "my.toml:2:1: unknown key 'tube.diametre'\n  what to do: did you mean 'tube.diameter'?");
}

TEST(CaseErrors, ColumnsCountLettersNotBytes) {
    const Error error = error_of([] { io::parse_case("materials.\"µµµ\" = 5\n", "my.toml"); });
    EXPECT_THAT(error.problem(), HasSubstr("is a table of keys"));
    EXPECT_EQ(error.place().column, 11);
    EXPECT_EQ(error_of([] { io::parse_case("materials.\"µµµ\".density = 5\n", "my.toml"); }).place().column, 27);
}

TEST(CaseErrors, OverridesNameThemselves) {
    const auto message = [](const std::string& override_text) { return std::string(error_of([&] { io::parse_case("", "my.toml", {override_text}); }).what()); };
    EXPECT_THAT(message("drum.speed=50"), HasSubstr("override 'drum.speed=50': drum.speed: '50' has no unit"));
    EXPECT_THAT(message("drum.sped=50 rpm"), HasSubstr("did you mean 'drum.speed'?"));
    EXPECT_THAT(message("drum.speed"), HasSubstr("an override is key=value"));
    EXPECT_THAT(message("=5"), HasSubstr("an override is key=value"));
    EXPECT_THAT(message("drum=5"), HasSubstr("drum is a table of keys"));
    EXPECT_THAT(message("pellet.count=1e3"), HasSubstr("pellet.count must be a whole number"));
    EXPECT_THAT(message("pellet.count="), HasSubstr("pellet.count must be a whole number"));
    EXPECT_THAT(message("output.paraview=no"), HasSubstr("must be true or false"));
    EXPECT_THAT(message("rig=tub"), HasSubstr("did you mean \"tube\"?"));
    EXPECT_THAT(message("gravity=1 m/s^2"), HasSubstr("gravity needs three values, and there are 1"));
    EXPECT_THAT(message("time.step=-1 s"), HasSubstr("override 'time.step=-1 s': time.step = -1 s is out of range"));
    EXPECT_THAT(message("materials.glass.density=1 kg/m^3"), HasSubstr("override 'materials.glass.density=1 kg/m^3': materials.glass has no shear_modulus"));
    EXPECT_THAT(message("pellet.material=glass"), HasSubstr("override 'pellet.material=glass': pellet.material: the material 'glass' is not defined"));
}
