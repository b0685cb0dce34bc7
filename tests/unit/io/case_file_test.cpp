#include "io/case_file.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/random.hpp"
#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;

namespace {

Case parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return io::parse_case(text, "a.toml", overrides);
}

/// A case in which every value differs from its default and most need 17 digits.
Case awkward_case(Rig rig, std::uint64_t stream) {
    RandomStream random(3, stream);
    const auto positive = [&random] { return std::exp(random.uniform(-12.0, 3.0)); };
    Case c = io::default_case(rig);
    c.name = "quote \" backslash \\ tab \t newline \n bell \x07 µ 3.1";
    c.seed = random.bits() >> 2;
    c.gravity = {random.normal(), -positive(), random.normal()};
    c.pellet = {"some where/clump.toml", 17, 1.03, "γ-alumina 5.1"};
    c.materials.clear();
    c.materials["γ-alumina 5.1"] = {positive() * 1e5, positive() * 1e9, random.uniform(-0.9, 0.49)};
    c.materials["perspex"] = {positive(), positive(), 0.1 + 0.2};
    c.contacts.clear();
    for (const std::string& name : {std::string("pellet-pellet"), std::string("pellet-perspex"), "pellet-" + wall_names(c).front()})
        c.contacts[name] = {random.uniform(), positive(), positive()};
    c.tube = {positive() + 0.01, positive(), rig == Rig::tube && stream % 2 == 1, 97, "tube.stl", "in", "perspex", "facets"};
    c.drum = {positive() + 0.01, positive(), -positive(), random.uniform(), random.uniform(), 33, false, "drum.stl", "um", "perspex", "facets"};
    if (stream % 5 == 3) {  // an exact surface, which goes without a mesh
        c.tube.surface = c.drum.surface = "exact";
        c.tube.mesh_file = c.tube.mesh_unit = c.drum.mesh_file = c.drum.mesh_unit = "";
    }
    for (const char* name : {"lifter", "γ \"wall\""}) {
        ExtraWall& w = c.walls[name];
        w.shape = rig == Rig::drum ? "box" : "cone", w.material = "perspex", w.turns = rig == Rig::drum || rig == Rig::tester;
        w.point = {random.normal(), 0.1 + 0.2, -positive()}, w.axis = {random.normal(), random.normal(), 1.0 / 3.0};
        w.radius = positive(), w.far_radius = positive(), w.length = positive(), w.size = {positive(), positive(), positive()};
    }
    c.physics.air_viscosity = positive();
    c.pile = {stream % 3 == 0 ? "cylinder" : "funnel", positive(), positive(), positive(), positive(), "c.stl", "mm", "perspex"};
    c.funnel = {positive() * 0.01, 0.5 + positive(), random.uniform(), 0.0, positive(), 31, "f.stl", "km"};
    c.tester = {positive() + 0.02, positive(), 0.01, 0.003, random.normal(), positive(), 17, "t.stl", "b.stl", "in", "perspex"};
    c.insertion = {c.tube.lying ? "cloud" : "batches", random.uniform() / 2.0, positive(), 3, positive(), 0.0, 7, positive(), positive()};
    if (rig == Rig::tube && stream % 4 == 2)
        c.insertion.way = "funnel", c.funnel.outlet_diameter = 0.5 * c.tube.diameter, c.funnel.top_diameter = c.tube.diameter;
    c.time = {positive() * 1e-4, 1.0 / 3.0, positive(), random.uniform(), positive(), 0.5 + positive()};
    c.output = {0.1 + 1.0 / 3.0, false, 3, false, true, 277};
    c.measurement = {0.01 / 3.0, 0.01 / 7.0};
    return c;
}

}  // namespace

TEST(CaseFile, EmptyTextIsTheDefaultCase) {
    EXPECT_EQ(parsed(""), io::default_case(Rig::tube));
    EXPECT_EQ(parsed("rig = \"drum\""), io::default_case(Rig::drum));
    const Case c = parsed("");
    EXPECT_EQ(c.materials.at("pellet"), (Material{1800.0, 2e6, 0.25}));  // the study's Table 1
    EXPECT_EQ(c.materials.at("vessel"), (Material{1000.0, 3e9, 0.25}));
    EXPECT_EQ(c.contacts.at("pellet-pellet"), (ContactParameters{0.4, 0.7, 0.07}));  // run 12 of its Table 4
    EXPECT_EQ(c.contacts.at("pellet-vessel"), (ContactParameters{0.4, 0.7, 0.05}));
    EXPECT_EQ(parsed("rig = \"drum\"").pellet.count, 0u);
}

TEST(CaseFile, DefaultsAreThoseOfTheStruct) {
    Case bare = io::default_case(Rig::tube);
    bare.materials.clear();
    bare.contacts.clear();
    EXPECT_EQ(bare, Case{});
}

TEST(CaseFile, NewCaseReadsBackToTheDefaultCase) {
    for (const Rig rig : all_rigs) {
        const std::string text = io::new_case_text(rig);
        EXPECT_EQ(parsed(text), io::default_case(rig)) << text;
        for (const Rig other : all_rigs) EXPECT_EQ(text.find("[" + rig_name(other) + "]") != std::string::npos, other == rig) << text;
    }
}

TEST(CaseFile, ResolvedTextReadsBackToTheSameBits) {
    for (const Rig rig : all_rigs) {
        EXPECT_EQ(parsed(io::resolved_case_text(io::default_case(rig))), io::default_case(rig));
        for (std::uint64_t stream = 0; stream < 200; ++stream) {
            const Case c = awkward_case(rig, stream);
            const std::string text = io::resolved_case_text(c);
            EXPECT_EQ(parsed(text), c) << text;
            EXPECT_EQ(io::resolved_case_text(parsed(text)), text);
        }
    }
}

TEST(CaseFile, ValuesAreReadWithTheirUnits) {
    const Case c = parsed(R"(
rig = "drum"
gravity = ["0 m/s^2", "0 mm/s^2", "-9810 mm/s^2"]
[drum]
diameter = "8 cm"
speed = "120 deg/s"
fill_fraction = "20 %"
end_plates_rotate = false
[time]
step = "10 us"
[contacts.pellet-pellet]
restitution = 1
)");
    EXPECT_EQ(c.gravity, Vec3(0.0, 0.0, -9.81));
    EXPECT_EQ(c.drum.diameter, 0.08);
    EXPECT_DOUBLE_EQ(c.drum.speed, 2.0943951023931953);
    EXPECT_EQ(c.drum.fill_fraction, 0.2);
    EXPECT_FALSE(c.drum.end_plates_rotate);
    EXPECT_EQ(c.time.step, 1e-5);
    EXPECT_EQ(c.contacts.at("pellet-pellet"), (ContactParameters{1.0, 0.7, 0.07}));  // what the row leaves out is the default
}

TEST(CaseFile, OverridesComeAfterTheFile) {
    const std::string file = "rig = \"tube\"\nseed = 4\n[drum]\nspeed = \"30 rpm\"\n";
    const Case c = parsed(file, {"rig=drum", "drum.speed = 50 rpm", "seed=7", "drum.end_plates_rotate=false", "gravity=0 m/s^2, 0 m/s^2, -1.62 m/s^2",
                                 "pellet.clump_file=\"my clump.toml\"", "contacts.pellet-pellet.sliding_friction=30 %", "seed=8"});
    EXPECT_EQ(c.rig, Rig::drum);
    EXPECT_EQ(c.name, "drum");  // defaults are those of the rig that the override chose
    EXPECT_EQ(c.pellet.count, 0u);
    EXPECT_DOUBLE_EQ(c.drum.speed, 5.2359877559829888);
    EXPECT_EQ(c.seed, 8u);
    EXPECT_FALSE(c.drum.end_plates_rotate);
    EXPECT_EQ(c.gravity[2], -1.62);
    EXPECT_EQ(c.pellet.clump_file, "my clump.toml");
    EXPECT_EQ(c.contacts.at("pellet-pellet"), (ContactParameters{0.4, 0.3, 0.07}));
    EXPECT_EQ(parsed("", {"gravity=[\"0 m/s^2\", '0 m/s^2', \"-1 m/s^2\"]"}).gravity[2], -1.0);
}

TEST(CaseFile, OwnMaterialsTakeThePlaceOfTheDefaults) {
    const Case c = parsed(R"(
[tube]
material = "steel 1.4301"
[materials."steel 1.4301"]
density = "7.9 g/cm^3"
shear_modulus = "77 GPa"
poisson_ratio = 0.3
[contacts.pellet-floor]
restitution = 0.6
sliding_friction = 0.3
rolling_friction = 0.01
[contacts.pellet-shell]
restitution = 0.7
sliding_friction = 0.3
rolling_friction = 0.01
)");
    EXPECT_EQ(c.materials.size(), 2u);  // pellet, which the rig refers to, and steel; no vessel
    EXPECT_EQ(c.materials.at("steel 1.4301").density, 7900.0);
    EXPECT_EQ(c.contacts.size(), 3u);
    EXPECT_EQ(parsed("", {"materials.steel.density=7900 kg/m^3", "materials.steel.shear_modulus=77 GPa", "materials.steel.poisson_ratio=0.3"})
                  .materials.at("steel")
                  .shear_modulus,
              77e9);
}

TEST(CaseFile, PathsStartAtTheFolderOfTheCase) {
    const test::TemporaryFolder folder;
    io::write_text(folder / "my.toml", "[pellet]\ncount = 5\n");
    const Case c = io::read_case(folder / "my.toml", {"seed=9"});
    EXPECT_EQ(c.pellet.count, 5u);
    EXPECT_EQ(c.seed, 9u);
    EXPECT_EQ(c.folder, folder.path().string());
    EXPECT_EQ(io::path_in_case(c, "sub/a.toml"), folder / "sub/a.toml");
    EXPECT_EQ(io::path_in_case(c, "/elsewhere/a.toml"), "/elsewhere/a.toml");
}

TEST(CaseFile, ExamplesOfTheRepositoryAreValid) {
    const std::filesystem::path examples = std::filesystem::path(PELLETLAB_SOURCE_DIR) / "examples";
    const Case tube = io::read_case(examples / "tube.toml");
    EXPECT_EQ(tube.rig, Rig::tube);
    EXPECT_EQ(tube.pellet.count, 1000u);
    EXPECT_EQ(tube.tube.diameter, 0.052);
    const Case drum = io::read_case(examples / "drum.toml");
    EXPECT_EQ(drum.rig, Rig::drum);
    EXPECT_EQ(drum.drum.diameter, 0.080);
    EXPECT_EQ(drum.drum.length, 0.020);
    EXPECT_EQ(drum.drum.fill_fraction, 0.2);
    for (const Case& c : {tube, drum}) {  // run 12 of the study's Table 4
        EXPECT_EQ(c.contacts.at("pellet-pellet"), (ContactParameters{0.4, 0.7, 0.07}));
        EXPECT_EQ(c.contacts.at("pellet-vessel"), (ContactParameters{0.4, 0.7, 0.05}));
        EXPECT_EQ(c.pellet.clump_file, "pellet.clump.toml");
    }
    EXPECT_EQ(io::read_case(examples / "drum.toml", {"drum.speed=50 rpm"}).drum.speed, parsed("", {"drum.speed=50 rpm"}).drum.speed);
}
