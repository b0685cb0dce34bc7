#include "io/trajectory_file.hpp"

#include <gmock/gmock.h>

#include "core/random.hpp"
#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using pelletlab::test::bits;
using pelletlab::test::error_of;
using pelletlab::test::same_bits;
using testing::HasSubstr;

namespace {

TriangleMesh tetrahedron(double size) {
    return {{{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size / 3.0}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

Trajectory random_trajectory(std::size_t bodies, std::size_t walls, std::size_t frames) {
    RandomStream random(5, 0);
    const auto vector = [&random] { return Vec3(random.normal(), random.normal(), random.normal()); };
    Trajectory t;
    t.head.case_name = "tube µ";
    t.head.gravity = {0.1, 1.0 / 3.0, -9.81};
    t.head.resolved_case = "rig = \"tube\"\n# " + std::string(5000, 'x') + "\n";
    t.head.provenance = {"pelletlab", "0.1.0", "", "fill", 18446744073709551615ull, {{"a.toml", "12"}, {"b c.toml", "34"}}};
    PelletShape cylinder, ball;
    cylinder.rigid.name = "cylinder";
    for (int i = 0; i < 5; ++i) cylinder.rigid.spheres.push_back({vector(), random.uniform()});
    cylinder.rigid.mass_properties = {1.0 / 3.0, 1800.0, 600.0, vector(), random.rotation(), {1.0, 2.0, 2.5}};
    cylinder.rigid.bounding_radius = bounding_radius(cylinder.rigid.spheres);
    cylinder.surface_body = tetrahedron(0.1);
    ball.rigid.name = "";  // neither name nor surface
    ball.rigid.spheres = {{Vec3::Zero(), 1.0}};
    ball.rigid.mass_properties = {1.0, 1.0, 1.0, Vec3::Zero(), Quat::Identity(), Vec3::Ones()};
    t.head.shapes = {cylinder, ball};
    for (std::size_t i = 0; i < bodies; ++i) t.head.shape_of_body.push_back(static_cast<std::uint32_t>(i % 2));
    for (std::size_t i = 0; i < walls; ++i) t.head.walls.push_back({"wall " + std::to_string(i), tetrahedron(1.0 + static_cast<double>(i))});
    for (std::size_t k = 0; k < frames; ++k) {
        Frame frame;
        frame.time = static_cast<double>(k) / 3.0;
        for (std::size_t i = 0; i < bodies; ++i) {
            frame.positions.push_back(vector());
            frame.orientations.push_back(random.rotation());
            frame.velocities.push_back(vector());
            frame.spins.push_back(vector());
        }
        for (std::size_t i = 0; i < walls; ++i) frame.wall_poses.push_back({vector(), random.rotation()});
        t.frames.push_back(frame);
    }
    return t;
}

void write(const Trajectory& t, const std::filesystem::path& file) {
    io::TrajectoryWriter writer(file, t.head);
    for (const Frame& frame : t.frames) writer.append(frame);
    writer.finish();
}

void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
    EXPECT_EQ(a.faces, b.faces);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    for (std::size_t i = 0; i < a.vertices.size(); ++i) EXPECT_TRUE(same_bits(a.vertices[i], b.vertices[i]));
}

void expect_same(const TrajectoryHeader& a, const TrajectoryHeader& b) {
    EXPECT_EQ(a.case_name, b.case_name);
    EXPECT_EQ(a.resolved_case, b.resolved_case);
    EXPECT_TRUE(same_bits(a.gravity, b.gravity));
    EXPECT_EQ(a.shape_of_body, b.shape_of_body);
    ASSERT_EQ(a.shapes.size(), b.shapes.size());
    for (std::size_t i = 0; i < a.shapes.size(); ++i) {
        const RigidTemplate &r = a.shapes[i].rigid, &s = b.shapes[i].rigid;
        EXPECT_EQ(r.name, s.name);
        ASSERT_EQ(r.spheres.size(), s.spheres.size());
        for (std::size_t k = 0; k < r.spheres.size(); ++k)
            EXPECT_TRUE(same_bits(r.spheres[k].centre, s.spheres[k].centre) && bits(r.spheres[k].radius) == bits(s.spheres[k].radius));
        EXPECT_EQ(bits(r.bounding_radius), bits(s.bounding_radius));
        EXPECT_EQ(bits(r.mass_properties.volume), bits(s.mass_properties.volume));
        EXPECT_EQ(bits(r.mass_properties.density), bits(s.mass_properties.density));
        EXPECT_EQ(bits(r.mass_properties.mass), bits(s.mass_properties.mass));
        EXPECT_TRUE(same_bits(r.mass_properties.centre_of_mass_mesh, s.mass_properties.centre_of_mass_mesh));
        EXPECT_TRUE(same_bits(r.mass_properties.principal_axes, s.mass_properties.principal_axes));
        EXPECT_TRUE(same_bits(r.mass_properties.principal_inertia, s.mass_properties.principal_inertia));
        expect_same(a.shapes[i].surface_body, b.shapes[i].surface_body);
    }
    ASSERT_EQ(a.walls.size(), b.walls.size());
    for (std::size_t i = 0; i < a.walls.size(); ++i) {
        EXPECT_EQ(a.walls[i].name, b.walls[i].name);
        expect_same(a.walls[i].mesh, b.walls[i].mesh);
    }
    EXPECT_EQ(a.provenance.git_hash, b.provenance.git_hash);
    EXPECT_EQ(a.provenance.verb, b.provenance.verb);
    EXPECT_EQ(a.provenance.seed, b.provenance.seed);
    EXPECT_EQ(a.provenance.input_hashes, b.provenance.input_hashes);
}

void expect_same(const Frame& a, const Frame& b) {
    EXPECT_EQ(bits(a.time), bits(b.time));
    ASSERT_EQ(a.positions.size(), b.positions.size());
    ASSERT_EQ(a.orientations.size(), b.orientations.size());
    ASSERT_EQ(a.velocities.size(), b.velocities.size());
    ASSERT_EQ(a.spins.size(), b.spins.size());
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        EXPECT_TRUE(same_bits(a.positions[i], b.positions[i]) && same_bits(a.velocities[i], b.velocities[i]) && same_bits(a.spins[i], b.spins[i]));
        EXPECT_TRUE(same_bits(a.orientations[i], b.orientations[i]));
    }
    ASSERT_EQ(a.wall_poses.size(), b.wall_poses.size());
    for (std::size_t i = 0; i < a.wall_poses.size(); ++i)
        EXPECT_TRUE(same_bits(a.wall_poses[i].position, b.wall_poses[i].position) && same_bits(a.wall_poses[i].orientation, b.wall_poses[i].orientation));
}

}  // namespace

TEST(TrajectoryFile, ComesBackBitForBit) {
    const test::TemporaryFolder folder;
    // many bodies: one frame a chunk; few: many frames a chunk, and more frames than one chunk holds
    for (const auto& [bodies, frames] : {std::pair<std::size_t, std::size_t>{20000, 3}, {7, 2500}, {1, 1}, {3, 0}, {0, 4}}) {
        for (const std::size_t walls : {0u, 3u}) {
            const Trajectory t = random_trajectory(bodies, walls, frames);
            write(t, folder / "run.h5");
            const auto back = io::open_trajectory(folder / "run.h5");
            expect_same(back->header(), t.head);
            ASSERT_EQ(back->frame_count(), frames);
            for (std::size_t i = 0; i < frames; i += 1 + frames / 100) {
                EXPECT_EQ(back->time(i), t.frames[i].time);
                expect_same(back->frame(i), t.frames[i]);
            }
            if (frames > 0) expect_same(back->frame(frames - 1), t.frames.back());
            EXPECT_THROW(back->frame(frames), std::out_of_range);
        }
    }
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(TrajectoryFile, EqualRunsGiveEqualFiles) {
    const test::TemporaryFolder folder;
    const Trajectory t = random_trajectory(10, 2, 5);
    write(t, folder / "a.h5");
    write(t, folder / "b.h5");
    EXPECT_EQ(io::sha256_of_file(folder / "a.h5"), io::sha256_of_file(folder / "b.h5"));
}

TEST(TrajectoryFile, OldFileStaysUntilTheNewOneIsFinished) {
    const test::TemporaryFolder folder;
    const Trajectory t = random_trajectory(4, 1, 2);
    write(t, folder / "run.h5");
    const std::string old = io::sha256_of_file(folder / "run.h5");
    {
        io::TrajectoryWriter writer(folder / "run.h5", t.head);
        writer.append(t.frames[1]);
        EXPECT_EQ(folder.entries(), 2u);
    }  // no finish(): an interrupted run
    EXPECT_EQ(io::sha256_of_file(folder / "run.h5"), old);
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(TrajectoryFile, FramesOfAnotherSizeAreRefused) {
    const test::TemporaryFolder folder;
    Trajectory t = random_trajectory(4, 1, 1);
    io::TrajectoryWriter writer(folder / "run.h5", t.head);
    t.frames[0].spins.pop_back();
    EXPECT_THAT(error_of([&] { writer.append(t.frames[0]); }).what(), HasSubstr("another number of bodies"));
}

TEST(TrajectoryFile, ForeignAndDamagedFilesAreRefused) {
    const test::TemporaryFolder folder;
    EXPECT_THAT(error_of([&] { io::open_trajectory(folder / "none.h5"); }).what(), HasSubstr("there is no such file"));
    EXPECT_THAT(error_of([&] { io::open_trajectory(folder.path()); }).what(), HasSubstr("there is no such file"));
    test::put(folder / "text.h5", "this is no HDF5");
    EXPECT_THAT(error_of([&] { io::open_trajectory(folder / "text.h5"); }).what(), HasSubstr("this is no HDF5 file"));
    const Trajectory t = random_trajectory(500, 2, 20);
    write(t, folder / "run.h5");
    const std::string good = io::read_text(folder / "run.h5");
    for (const double part : {0.01, 0.3, 0.9, 0.999}) {
        test::put(folder / "cut.h5", good.substr(0, static_cast<std::size_t>(part * static_cast<double>(good.size()))));
        const Error error = error_of([&] { io::open_trajectory(folder / "cut.h5"); });
        EXPECT_EQ(error.exit_code(), 3);
        EXPECT_EQ(error.place().file, (folder / "cut.h5").string());
    }
}

TEST(TrajectoryFile, FlippedBitsInFramesAreNoticed) {
    // The checksum of a chunk finds what HDF5 itself would hand over as numbers. Flip bytes in the middle of the file, where the frames lie.
    const test::TemporaryFolder folder;
    const Trajectory t = random_trajectory(2000, 0, 10);
    write(t, folder / "run.h5");
    std::string bytes = io::read_text(folder / "run.h5");
    for (std::size_t at = bytes.size() / 2; at < bytes.size() / 2 + 8; ++at) bytes[at] = static_cast<char>(~bytes[at]);
    test::put(folder / "run.h5", bytes);
    EXPECT_THROW(
        {
            const auto back = io::open_trajectory(folder / "run.h5");
            for (std::size_t i = 0; i < back->frame_count(); ++i) back->frame(i);
        },
        Error);
}

TEST(TrajectoryFile, AnyFlippedBitIsNoticedBeforeTheLibraryLooks) {
    // Flips in the structures of the file made HDF5 hang, about one in six thousand; the seal finds them all, and quickly.
    const test::TemporaryFolder folder;
    write(random_trajectory(20, 1, 3), folder / "run.h5");
    const std::string good = io::read_text(folder / "run.h5");
    RandomStream random(9, 0);
    for (int k = 0; k < 300; ++k) {
        std::string bytes = good;
        const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()));
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << static_cast<int>(random.uniform() * 8.0)));
        test::put(folder / "run.h5", bytes);
        EXPECT_THROW(io::open_trajectory(folder / "run.h5"), Error) << at;
    }
    test::put(folder / "run.h5", good + "x");
    EXPECT_THAT(error_of([&] { io::open_trajectory(folder / "run.h5"); }).what(), HasSubstr("seal"));
}

TEST(TrajectoryFile, UnwritablePlaceIsAnError) {
    const test::TemporaryFolder folder;
    test::put(folder / "file", "x");
    const Trajectory t = random_trajectory(1, 0, 1);
    EXPECT_THAT(error_of([&] { io::TrajectoryWriter(folder / "file" / "run.h5", t.head); }).what(), HasSubstr("cannot be written"));
}
