#include "io/trajectory_segments.hpp"

#include <gmock/gmock.h>

#include "core/random.hpp"
#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using pelletlab::test::error_of;
using testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

Frame frame_at(int k) {
    RandomStream random(7, static_cast<std::uint64_t>(k));
    Frame frame;
    frame.time = 0.1 * k;
    for (int i = 0; i < 5; ++i) {
        frame.positions.push_back({random.uniform(), random.uniform(), random.uniform()});
        frame.orientations.push_back(random.rotation());
        frame.velocities.push_back({random.normal(), random.normal(), random.normal()});
        frame.spins.push_back({random.normal(), random.normal(), random.normal()});
    }
    frame.wall_poses.push_back({Vec3::Zero(), random.rotation()});
    return frame;
}

TrajectoryHeader header() {
    TrajectoryHeader head;
    head.case_name = "pieces";
    head.shapes.resize(1);
    head.shapes[0].rigid.spheres = {{Vec3::Zero(), 1.0}};
    head.shapes[0].surface_body = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    head.shape_of_body.assign(5, 0);
    head.walls.push_back({"floor", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}});
    return head;
}

void write_whole(const fs::path& file, int frames) {
    io::TrajectoryWriter writer(file, header());
    for (int k = 0; k < frames; ++k) writer.append(frame_at(k));
    writer.finish();
}

TEST(TrajectorySegments, PiecesBecomeTheVeryFileOfOnePiece) {
    const test::TemporaryFolder folder;
    write_whole(folder / "whole.h5", 10);
    for (const std::vector<int>& cuts : {std::vector<int>{}, {1}, {3, 7}, {2, 3, 4, 9}}) {
        fs::create_directory(folder / "pieces");
        io::SegmentedTrajectoryWriter writer(folder / "pieces", header(), 0);
        for (int k = 0; k < 10; ++k) {
            if (std::find(cuts.begin(), cuts.end(), k) != cuts.end()) writer.secure();
            writer.append(frame_at(k));
        }
        writer.secure();
        writer.secure();  // nothing new: no piece
        writer.finish(folder / "run.h5");
        EXPECT_TRUE(io::read_text(folder / "run.h5") == io::read_text(folder / "whole.h5")) << cuts.size();
        EXPECT_EQ(io::SegmentedFrames(folder / "pieces").frame_count(), 10u);
        EXPECT_EQ(io::SegmentedFrames(folder / "pieces").frame(6).positions[3], frame_at(6).positions[3]);
        fs::remove_all(folder / "pieces");
    }
}

TEST(TrajectorySegments, FramesBehindTheCheckpointAreWrittenAgain) {
    const test::TemporaryFolder folder;
    {
        io::SegmentedTrajectoryWriter writer(folder.path(), header(), 0);
        for (int k = 0; k < 4; ++k) writer.append(frame_at(k));
        writer.secure();  // the checkpoint counts these
        for (int k = 4; k < 6; ++k) writer.append(frame_at(k));
        writer.secure();             // killed before the checkpoint that would count these, …
        writer.append(frame_at(6));  // … or in the middle of a piece
    }
    test::put(folder / "frames.0002.h5.part", "half a piece");
    io::SegmentedTrajectoryWriter writer(folder.path(), header(), 4);
    EXPECT_FALSE(fs::exists(folder / "frames.0001.h5"));
    EXPECT_FALSE(fs::exists(folder / "frames.0002.h5.part"));
    for (int k = 4; k < 10; ++k) writer.append(frame_at(k));
    writer.finish(folder / "run.h5");
    write_whole(folder / "whole.h5", 10);
    EXPECT_TRUE(io::read_text(folder / "run.h5") == io::read_text(folder / "whole.h5"));
}

TEST(TrajectorySegments, PiecesThatDoNotFitTheCheckpointAreRefused) {
    const test::TemporaryFolder folder;
    {
        io::SegmentedTrajectoryWriter writer(folder.path(), header(), 0);
        for (int k = 0; k < 4; ++k) writer.append(frame_at(k));
        writer.secure();
    }
    EXPECT_THAT(error_of([&] { io::SegmentedTrajectoryWriter(folder.path(), header(), 3); }).what(), HasSubstr("do not fit the checkpoint"));
    EXPECT_THAT(error_of([&] { io::SegmentedTrajectoryWriter(folder.path(), header(), 5); }).what(), HasSubstr("do not fit the checkpoint"));
}

}  // namespace
