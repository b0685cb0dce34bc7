#include "io/clump_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using pelletlab::test::bits;
using pelletlab::test::error_of;
using pelletlab::test::same_bits;
using testing::HasSubstr;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Random numbers of the size of a pellet: nearly all of them need 17 digits.
ClumpTemplate random_clump(std::uint64_t stream) {
    RandomStream random(11, stream);
    const auto length = [&random] { return random.uniform(-2e-3, 2e-3); };
    ClumpTemplate c;
    c.rigid.name = "cylinder \"3.12 × 2.96\"";
    for (int i = 0; i < 82; ++i) c.rigid.spheres.push_back({{length(), length(), length()}, random.uniform(1e-4, 8e-4)});
    c.rigid.bounding_radius = bounding_radius(c.rigid.spheres);
    MassProperties& m = c.rigid.mass_properties;
    m.density = random.uniform(1000.0, 3000.0);
    m.volume = random.uniform(1e-8, 3e-8);
    m.mass = m.density * m.volume;
    m.centre_of_mass_mesh = {length(), -0.0, length()};
    m.principal_axes = random.rotation();
    m.principal_inertia = Vec3(1.0 + random.uniform(), 1.5 + random.uniform() / 2.0, 2.0) * 1e-11;
    c.mass_source = MassSource::density_matched_union;
    c.quality.volume_error = random.normal() * 1e-3;
    c.quality.inertia_error = {random.normal(), random.normal(), random.normal()};
    c.quality.centre_offset = 1e-300;
    c.quality.symmetric_difference = random.uniform();
    c.quality.missing = random.uniform();
    c.quality.outside = random.uniform();
    c.quality.target_to_union = {length(), length(), length(), length(), length()};
    c.quality.union_to_target = {length(), length(), length(), length(), length()};
    c.quality.both = {length(), length(), length(), length(), length()};
    SurfaceFigures& f = c.quality.surface;
    for (double* value : {&f.flat_sq, &f.flat_sz, &f.curved_sq, &f.curved_sz, &f.edge_gap_mean, &f.edge_gap_max, &f.edge_radius_mean, &f.edge_radius_max,
                          &f.support_mean, &f.support_rms, &f.support_max, &f.press, &f.smallest_radius, &f.largest_radius})
        *value = length();
    f.normal_mean = 0.3;
    f.normal_rms = 0.4;
    f.normal_p95 = 0.5;
    f.contacts_on_flat = 16.5;
    f.most_on_flat = 17;
    f.contacts_any_way = 2.25;
    f.most_any_way = 18;
    f.components = 1;
    f.sealed_volume = 1e-13;
    for (MassProperties* m : {&c.masses.mesh, &c.masses.of_union, &c.masses.sum}) {
        m->density = 1800.0;
        m->volume = random.uniform(1e-8, 3e-8);
        m->mass = m->density * m->volume;
        m->centre_of_mass_mesh = {length(), length(), length()};
        m->principal_inertia = Vec3(1.0, 1.5, 2.0) * 1e-11;
    }
    c.quality.distance_error_bound = 5e-324;
    c.mesh_file = "a folder/pellet \\ 1.stl";
    c.mesh_unit = "mm";
    c.mesh_hash = "00ff";
    c.provenance = {"pelletlab", "0.1.0", "abc-dirty", "shape", std::numeric_limits<std::uint64_t>::max(), {{"meshes/a b.stl", "12"}, {"z", "34"}}};
    return c;
}

void expect_same(const DistanceFigures& a, const DistanceFigures& b) {
    EXPECT_EQ(bits(a.mean), bits(b.mean));
    EXPECT_EQ(bits(a.rms), bits(b.rms));
    EXPECT_EQ(bits(a.max), bits(b.max));
    EXPECT_EQ(bits(a.p99), bits(b.p99));
    EXPECT_EQ(bits(a.signed_mean), bits(b.signed_mean));
}

void expect_same(const SurfaceFigures& a, const SurfaceFigures& b) {
    const double lengths[][2] = {{a.flat_sq, b.flat_sq},
                                 {a.flat_sz, b.flat_sz},
                                 {a.curved_sq, b.curved_sq},
                                 {a.curved_sz, b.curved_sz},
                                 {a.edge_gap_mean, b.edge_gap_mean},
                                 {a.edge_gap_max, b.edge_gap_max},
                                 {a.edge_radius_mean, b.edge_radius_mean},
                                 {a.edge_radius_max, b.edge_radius_max},
                                 {a.support_mean, b.support_mean},
                                 {a.support_rms, b.support_rms},
                                 {a.support_max, b.support_max},
                                 {a.press, b.press},
                                 {a.smallest_radius, b.smallest_radius},
                                 {a.largest_radius, b.largest_radius},
                                 {a.normal_mean, b.normal_mean},
                                 {a.normal_rms, b.normal_rms},
                                 {a.normal_p95, b.normal_p95},
                                 {a.contacts_on_flat, b.contacts_on_flat},
                                 {a.contacts_any_way, b.contacts_any_way},
                                 {a.sealed_volume, b.sealed_volume}};
    for (const auto& [mine, theirs] : lengths) EXPECT_EQ(bits(mine), bits(theirs));
    EXPECT_EQ(a.most_on_flat, b.most_on_flat);
    EXPECT_EQ(a.most_any_way, b.most_any_way);
    EXPECT_EQ(a.components, b.components);
}

void expect_same(const MassProperties& a, const MassProperties& b) {
    EXPECT_EQ(bits(a.density), bits(b.density));
    EXPECT_EQ(bits(a.volume), bits(b.volume));
    EXPECT_EQ(bits(a.mass), bits(b.mass));
    EXPECT_TRUE(same_bits(a.centre_of_mass_mesh, b.centre_of_mass_mesh));
    EXPECT_TRUE(same_bits(a.principal_inertia, b.principal_inertia));
}

void expect_same(const ClumpTemplate& a, const ClumpTemplate& b) {
    EXPECT_EQ(a.rigid.name, b.rigid.name);
    ASSERT_EQ(a.rigid.spheres.size(), b.rigid.spheres.size());
    for (std::size_t i = 0; i < a.rigid.spheres.size(); ++i) {
        EXPECT_TRUE(same_bits(a.rigid.spheres[i].centre, b.rigid.spheres[i].centre));
        EXPECT_EQ(bits(a.rigid.spheres[i].radius), bits(b.rigid.spheres[i].radius));
    }
    EXPECT_EQ(bits(a.rigid.bounding_radius), bits(b.rigid.bounding_radius));
    const MassProperties &m = a.rigid.mass_properties, &n = b.rigid.mass_properties;
    EXPECT_EQ(bits(m.volume), bits(n.volume));
    EXPECT_EQ(bits(m.density), bits(n.density));
    EXPECT_EQ(bits(m.mass), bits(n.mass));
    EXPECT_TRUE(same_bits(m.centre_of_mass_mesh, n.centre_of_mass_mesh));
    EXPECT_TRUE(same_bits(m.principal_axes, n.principal_axes));
    EXPECT_TRUE(same_bits(m.principal_inertia, n.principal_inertia));
    EXPECT_EQ(a.mass_source, b.mass_source);
    EXPECT_EQ(bits(a.quality.volume_error), bits(b.quality.volume_error));
    EXPECT_TRUE(same_bits(a.quality.inertia_error, b.quality.inertia_error));
    EXPECT_EQ(bits(a.quality.centre_offset), bits(b.quality.centre_offset));
    EXPECT_EQ(bits(a.quality.symmetric_difference), bits(b.quality.symmetric_difference));
    EXPECT_EQ(bits(a.quality.missing), bits(b.quality.missing));
    EXPECT_EQ(bits(a.quality.outside), bits(b.quality.outside));
    expect_same(a.quality.surface, b.quality.surface);
    expect_same(a.masses.mesh, b.masses.mesh);
    expect_same(a.masses.of_union, b.masses.of_union);
    expect_same(a.masses.sum, b.masses.sum);
    expect_same(a.quality.target_to_union, b.quality.target_to_union);
    expect_same(a.quality.union_to_target, b.quality.union_to_target);
    expect_same(a.quality.both, b.quality.both);
    EXPECT_EQ(bits(a.quality.distance_error_bound), bits(b.quality.distance_error_bound));
    EXPECT_EQ(a.mesh_file, b.mesh_file);
    EXPECT_EQ(a.mesh_unit, b.mesh_unit);
    EXPECT_EQ(a.mesh_hash, b.mesh_hash);
    EXPECT_EQ(a.provenance.tool, b.provenance.tool);
    EXPECT_EQ(a.provenance.version, b.provenance.version);
    EXPECT_EQ(a.provenance.git_hash, b.provenance.git_hash);
    EXPECT_EQ(a.provenance.verb, b.provenance.verb);
    EXPECT_EQ(a.provenance.seed, b.provenance.seed);
    EXPECT_EQ(a.provenance.input_hashes, b.provenance.input_hashes);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

/// One sphere, round numbers, so that the places in the text are known.
std::string small_clump_text() {
    ClumpTemplate c;
    c.rigid.name = "ball";
    c.rigid.spheres = {{Vec3::Zero(), 1e-3}};
    c.rigid.mass_properties = {4e-9, 2000.0, 8e-6, Vec3::Zero(), Quat::Identity(), Vec3(3e-12, 3e-12, 3e-12)};
    return io::clump_text(c);
}

int line_of(const std::string& text, const std::string& word) {
    const std::size_t at = text.find(word);
    EXPECT_NE(at, std::string::npos) << word;
    return static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
}

}  // namespace

TEST(ClumpFile, ComesBackBitForBit) {
    const test::TemporaryFolder folder;
    for (std::uint64_t stream = 0; stream < 50; ++stream) {
        const ClumpTemplate clump = random_clump(stream);
        io::write_clump(clump, folder / "pellet.clump.toml");
        expect_same(io::read_clump(folder / "pellet.clump.toml"), clump);
        if (HasFailure()) break;
    }
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(ClumpFile, ReadsAsWhatItIs) {
    const std::string text = small_clump_text();
    EXPECT_THAT(text, HasSubstr("# Clump template of pelletlab: 1 spheres, bounding radius 1.0000 mm, mass 8.000 mg"));
    EXPECT_THAT(text, HasSubstr("[\"0 mm\", \"0 mm\", \"0 mm\", \"1 mm\"]"));
    EXPECT_THAT(text, HasSubstr("density = \"2000 kg/m^3\""));
    EXPECT_THAT(text, HasSubstr("volume = \"4 mm^3\""));
    EXPECT_THAT(text, HasSubstr("mass = \"8 mg\""));
    EXPECT_THAT(text, HasSubstr("principal_inertia = [\"3 mg*mm^2\""));
}

TEST(ClumpFile, UnknownQualityStaysUnknown) {
    ClumpTemplate clump = random_clump(1);
    clump.quality.volume_error = unknown;
    clump.quality.both.max = unknown;
    const ClumpTemplate back = io::parse_clump(io::clump_text(clump), "a");
    EXPECT_TRUE(std::isnan(back.quality.volume_error));
    EXPECT_TRUE(std::isnan(back.quality.both.max));
    EXPECT_EQ(back.quality.both.mean, clump.quality.both.mean);
}

TEST(ClumpFile, FilesOfEarlierVersionsHaveNoSurface) {
    std::string text = io::clump_text(random_clump(3));
    const auto cut = [&text](const std::string& from, const std::string& to) {
        const auto begin = text.find(from);
        ASSERT_NE(begin, std::string::npos) << from;
        text.erase(begin, text.find(to, begin) - begin);
    };
    cut("[quality.surface]", "[masses]");
    cut("[masses]", "[mesh]");
    cut("missing = ", "body_to_union");
    const ClumpTemplate old = io::parse_clump(text, "a");
    EXPECT_TRUE(std::isnan(old.quality.surface.flat_sq));
    EXPECT_TRUE(std::isnan(old.quality.missing));
    EXPECT_EQ(old.masses.mesh.volume, 0.0);
    EXPECT_EQ(old.rigid.spheres.size(), 82u);
}

TEST(ClumpFile, ImpossibleClumpIsNotWritten) {
    const test::TemporaryFolder folder;
    ClumpTemplate clump = random_clump(2);
    clump.rigid.mass_properties.mass = unknown;
    EXPECT_THAT(error_of([&] { io::write_clump(clump, folder / "a.toml"); }).what(), HasSubstr("mass"));
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(ClumpFile, MistakesAreToldWithTheirPlace) {
    const std::string good = small_clump_text();
    ASSERT_NO_THROW(io::parse_clump(good, "a"));
    struct Mistake {
        std::string from, to, line_word;
        const char* message;
    };
    const Mistake mistakes[] = {
        {"format = \"pelletlab-clump\"", "format = \"other\"", "", "this is no clump template of pelletlab"},
        {"format_version = 1", "format_version = 2", "format_version", "version of the clump format"},
        {"name = \"ball\"", "nmae = \"ball\"", "", "the key 'name' is missing"},
        {"name = \"ball\"", "name = 5", "name", "name must be a text, and this is a whole number"},
        {"name = \"ball\"", "name = \"ball\"\nnames = 1", "names", "did you mean 'name'?"},
        {"volume_error =", "volume_eror =", "[quality]", "the key 'quality.volume_error' is missing"},
        {"volume_error = 0", "volume_error = 0\nvolume_eror = 0", "volume_eror", "unknown key 'quality.volume_eror'"},
        {"volume_error = 0", "volume_error = inf", "volume_error", "not a finite number"},
        {"density = \"2000 kg/m^3\"", "density = 2000", "density = ", "must be a text with number and unit"},
        {"density = \"2000 kg/m^3\"", "density = \"2000 mm\"", "density = ", "a unit of length"},
        {"density = \"2000 kg/m^3\"", "density = \"1000 kg/m^3\"", "mass = \"8", "is not density · volume"},
        {"mass = \"8 mg\"", "mass = \"-8 mg\"", "mass = \"-8", "mass is not positive"},
        {"mass = \"8 mg\"", "mass = \"not known\"", "mass = \"not", "mass is not positive"},
        {"\"1 mm\"]", "\"0 mm\"]", "\"0 mm\"]", "sphere 1 has no positive radius"},
        {"[\"0 mm\", \"0 mm\", \"0 mm\", \"1 mm\"]", "[\"0 mm\", \"0 mm\", \"1 mm\"]", "[\"0 mm\", \"0", "a list of 4 values"},
        {"[\"0 mm\", \"0 mm\", \"0 mm\", \"1 mm\"],", "", "spheres = [", "spheres is empty"},
        {"principal_axes = [1, 0", "principal_axes = [1, 0.1", "principal_axes", "no quaternion of length 1"},
        {"[\"3 mg*mm^2\"", "[\"9 mg*mm^2\"", "principal_inertia", "belongs to no body"},
        {"[\"3 mg*mm^2\"", "[\"0 mg*mm^2\"", "principal_inertia", "is not positive"},
        {"mass_source = \"target_mesh\"", "mass_source = \"target_mash\"", "mass_source", "did you mean 'target_mesh'?"},
        {"seed = \"0\"", "seed = \"0x\"", "seed", "whole number as text"},
        {"[mesh]", "[mash]", "", "the key 'mesh' is missing"},
        {"spheres = [", "spheres = [[", "", "this is no TOML"},
    };
    for (const Mistake& mistake : mistakes) {
        const std::string text = replaced(good, mistake.from, mistake.to);
        const Error error = error_of([&] { io::parse_clump(text, "my.clump.toml"); });
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        EXPECT_EQ(error.place().file, "my.clump.toml");
        EXPECT_THAT(error.what(), HasSubstr(mistake.message)) << mistake.to;
        EXPECT_EQ(error.place().line, mistake.line_word.empty() ? error.place().line : line_of(text, mistake.line_word)) << error.what();
    }
}

TEST(ClumpFile, CutShortIsAnError) {
    const std::string good = small_clump_text();
    const std::size_t last_table = good.find("[provenance.input_hashes]") + 24;  // cut later, only a comment is lost
    for (std::size_t length = 0; length < last_table; ++length) EXPECT_THROW(io::parse_clump(good.substr(0, length), "a"), Error) << length;
}
