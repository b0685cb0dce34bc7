#include "report/animation.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

AnimationSettings small_film() {
    AnimationSettings settings;
    settings.picture.width = 200;
    settings.picture.samples = 1;
    return settings;
}

Trajectory falling(std::size_t frames) {
    const testing::Bed bed = testing::bed_in_tube(10);
    Trajectory trajectory;
    trajectory.head = bed.header;
    for (std::size_t i = 0; i < frames; ++i) {
        trajectory.frames.push_back(bed.frame);
        trajectory.frames.back().time = 0.01 * static_cast<double>(i);
        for (Vec3& position : trajectory.frames.back().positions) position.z() += 0.004 * static_cast<double>(frames - 1 - i);
    }
    return trajectory;
}

TEST(Animation, WritesNumberedPicturesAndReportsProgress) {
    const testing::Folder folder;
    AnimationSettings settings = small_film();
    settings.every = 2;
    std::vector<double> done;
    const auto files = render_animation(falling(5), Subject::tube, folder / "film", settings, [&done](const Progress& p) { done.push_back(p.done); });
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[0].filename(), "frame_00000.png");
    EXPECT_EQ(files[2].filename(), "frame_00002.png");
    for (const auto& file : files) EXPECT_TRUE(std::filesystem::exists(file));
    EXPECT_EQ(done, (std::vector<double>{0.0, 1.0, 2.0, 3.0}));
}

TEST(Animation, DrumKeepsOneColourRange) {
    const testing::Folder folder;
    const testing::Bed bed = testing::bed_in_drum(10);
    Trajectory trajectory;
    trajectory.head = bed.header;
    trajectory.frames = {bed.frame, bed.frame};
    for (Vec3& velocity : trajectory.frames[0].velocities) velocity.setZero();
    EXPECT_EQ(render_animation(trajectory, Subject::drum, folder / "film", small_film()).size(), 2u);
}

TEST(Animation, TurntableGoesRound) {
    const testing::Folder folder;
    const testing::Bed bed = testing::bed_in_tube(10);
    const auto files = render_turntable(bed.header, bed.frame, 3, folder / "round", small_film());
    ASSERT_EQ(files.size(), 3u);
    EXPECT_NE(std::filesystem::file_size(files[0]), 0u);
}

TEST(Animation, RefusesNoFramesAndFoldersThatCannotBe) {
    const testing::Folder folder;
    EXPECT_THROW(render_animation(falling(0), Subject::tube, folder / "film", small_film()), Error);
    AnimationSettings never = small_film();
    never.every = 0;
    EXPECT_THROW(render_animation(falling(1), Subject::tube, folder / "film", never), Error);
    EXPECT_THROW(render_animation(falling(1), Subject::tube, "/proc/no/such/folder", small_film()), Error);
    const testing::Bed bed = testing::bed_in_tube(2);
    EXPECT_THROW(render_turntable(bed.header, bed.frame, 0, folder / "round", small_film()), Error);
}

}  // namespace
}  // namespace pelletlab::report
