// The same bits for any number of threads, any search skin, and across a checkpoint.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "scene.hpp"

namespace pelletlab::solver {
namespace {

Simulation falling_bed(SearchSkins skins = {}, InstructionSet instructions = InstructionSet::fastest) {
    SimulationDefinition d = scene::falling_definition(scene::cylinder_template(3, 8));
    d.skins = skins;
    d.instructions = instructions;
    d.walls.push_back(
        scene::wall("paddle", transformed(scene::plate(0.004), {{0.0, 0.0, 0.006}, Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitX()))}), {0.5, 0.5, 0.05}));
    d.walls.back().motion.axis = Vec3::UnitZ();
    Simulation s(d);
    std::vector<BodyPlacement> b = scene::lattice(4, 4, 14, 5.2e-3, 4);
    std::erase_if(b, [](const BodyPlacement& p) { return p.pose.position.z() < 0.013; });
    s.add_bodies(b);
    WallMotion turn;
    turn.axis = Vec3::UnitZ();
    turn.rotation_speed = 3.0;
    s.set_wall_motion(1, turn);
    return s;
}

class Threads : public testing::Test {
protected:
    void TearDown() override { set_thread_count(0); }
};

TEST_F(Threads, OneTwoAndThreeThreadsGiveTheSameBits) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3}) {
        set_thread_count(threads);
        Simulation s = falling_bed();
        s.advance(6000);
        EXPECT_GT(s.contacts().sphere_contacts, 100u);
        EXPECT_GT(s.contacts().wall_contacts, 20u);
        hashes.push_back(s.state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Reproducible, SearchSkinsChangeNoBit) {
    std::vector<std::uint64_t> hashes, rebuilds;
    for (const SearchSkins skins : {SearchSkins{}, SearchSkins{1e-4, 5e-6, 1e-4, 5e-6}, SearchSkins{2e-3, 4e-4, 2e-3, 4e-4}}) {
        Simulation s = falling_bed(skins);
        s.advance(5000);
        hashes.push_back(s.state_hash());
        rebuilds.push_back(s.neighbour_rebuilds());
    }
    EXPECT_NE(rebuilds[1], rebuilds[2]);
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Reproducible, InstructionSetsGiveTheSameBits) {
    std::vector<std::uint64_t> hashes;
    for (const InstructionSet set : {InstructionSet::scalar, InstructionSet::avx2, InstructionSet::avx512}) {
        try {
            Simulation s = falling_bed({}, set);
            s.advance(5000);
            hashes.push_back(s.state_hash());
        } catch (const Error& e) {
            ASSERT_NE(std::string(e.what()).find("lacks the instruction set"), std::string::npos);
        }
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
    if (hashes.size() < 3) GTEST_SKIP() << "this processor runs only " << hashes.size() << " of 3 instruction sets";
}

TEST(Reproducible, CandidateSearchFindsEveryContactOfBruteForce) {
    Simulation s = falling_bed();
    std::size_t checked = 0;
    for (int round = 0; round < 12; ++round) {
        s.advance(500);
        const BodyState& b = s.bodies();
        const RigidTemplate& t = s.definition().templates[0];
        std::size_t expected = 0;
        for (std::size_t i = 0; i < b.size(); ++i)
            for (std::size_t j = i + 1; j < b.size(); ++j) {
                if ((b.position[i] - b.position[j]).norm() > 2.0 * t.bounding_radius) continue;
                for (const Sphere& p : t.spheres)
                    for (const Sphere& q : t.spheres) {
                        const double distance = (b.position[i] + b.orientation[i] * p.centre - b.position[j] - b.orientation[j] * q.centre).norm();
                        if (p.radius + q.radius - distance > 0.0) ++expected;
                    }
            }
        checked += expected;
        EXPECT_EQ(s.contacts().sphere_contacts, expected);
    }
    EXPECT_GT(checked, 300u);
}

TEST(Reproducible, ContactHistorySurvivesRebuilds) {
    // A bed at rest, then bodies of which one runs around far away: its motion forces rebuilds; springs at rest must not change.
    Simulation s = falling_bed();
    s.advance(20000);
    double springs = 0.0;
    for (const ContactPoint& c : s.contact_points()) springs += c.spring.norm();
    EXPECT_GT(springs, 0.0);
    const std::uint64_t before = s.neighbour_rebuilds();
    Simulation other = falling_bed({2e-5, 0, 0, 0});
    other.advance(20000);
    EXPECT_GT(other.neighbour_rebuilds(), 2 * before);
    EXPECT_EQ(other.state_hash(), s.state_hash());
}

struct TemporaryFile {
    std::filesystem::path path = std::filesystem::temp_directory_path() /
                                 ("pelletlab_checkpoint_" + std::to_string(::getpid()) + "_" + testing::UnitTest::GetInstance()->current_test_info()->name());
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
};

TEST(Checkpoint, TwiceNIsNThenN) {
    const TemporaryFile file;
    Simulation straight = falling_bed();
    straight.advance(4000);
    straight.save_checkpoint(file.path);
    straight.advance(4000);
    Simulation resumed(straight.definition());
    resumed.load_checkpoint(file.path);
    EXPECT_EQ(resumed.step_count(), 4000u);
    resumed.advance(4000);
    EXPECT_EQ(resumed.state_hash(), straight.state_hash());
    EXPECT_EQ(resumed.wall_loads()[0].force, straight.wall_loads()[0].force);
}

TEST(Checkpoint, RestoredStateHasTheSameHash) {
    const TemporaryFile file;
    Simulation s = falling_bed();
    s.advance(5000);
    s.save_checkpoint(file.path);
    const std::uint64_t hash = s.state_hash();
    s.advance(100);
    EXPECT_NE(s.state_hash(), hash);
    s.load_checkpoint(file.path);
    EXPECT_EQ(s.state_hash(), hash);
}

void expect_refused(Simulation& s, const std::filesystem::path& path, const std::string& word) {
    const std::uint64_t before = s.state_hash();
    try {
        s.load_checkpoint(path);
        FAIL() << "not refused: " << word;
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::bad_input);
        EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
    EXPECT_EQ(s.state_hash(), before);
}

TEST(Checkpoint, DamagedAndForeignFilesAreRefusedAndChangeNothing) {
    const TemporaryFile file;
    Simulation s = falling_bed();
    s.advance(2000);
    s.save_checkpoint(file.path);
    std::string bytes;
    {
        std::ifstream in(file.path, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    const auto write = [&](const std::string& content) { std::ofstream(file.path, std::ios::binary) << content; };
    s.advance(10);
    for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{39}}) {
        write(bytes.substr(0, length));
        expect_refused(s, file.path, "not a checkpoint");
    }
    for (const double part : {0.1, 0.5, 0.999}) {
        write(bytes.substr(0, static_cast<std::size_t>(part * static_cast<double>(bytes.size()))));
        expect_refused(s, file.path, "cut off");
    }
    std::string turned = bytes;
    turned[bytes.size() / 2] = static_cast<char>(turned[bytes.size() / 2] ^ 1);
    write(turned);
    expect_refused(s, file.path, "checksum");
    write(bytes);
    SimulationDefinition other = s.definition();
    other.pellet_contact.sliding_friction += 1e-9;
    Simulation foreign(other);
    expect_refused(foreign, file.path, "another case");
    expect_refused(s, file.path.string() + ".missing", "cannot be read");
}

TEST(Checkpoint, AnUnwritableFolderIsAnErrorAndKeepsTheOldFile) {
    Simulation s = falling_bed();
    EXPECT_THROW(s.save_checkpoint("/no/such/folder/state.checkpoint"), Error);
}

}  // namespace
}  // namespace pelletlab::solver
