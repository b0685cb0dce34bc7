#include "io/tracked_particles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using namespace pelletlab::io;
using pelletlab::test::error_of;

namespace {

TrackedSettings spheres(double diameter = 3e-3) {
    TrackedSettings settings;
    settings.pellet = sphere_shape(diameter);
    return settings;
}

TrackedParticles parse(const std::string& text, const TrackedSettings& settings = spheres()) {
    return parse_tracked_particles(text, "tracks.csv", settings);
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
    EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " against " << b.transpose();
}

}  // namespace

TEST(TrackedParticles, ColumnsInAnyOrderSeparatorAndUnit) {
    // The same two pellets at one time, as five programs would write them.
    const std::vector<std::string> texts{"time [s],id,x [mm],y [mm],z [mm]\n0.5,7,1.5,2,3\n0.5,9,-1,-2,-3\n",
                                         "z (cm);x (m);y (um);Time (ms);Particle\n0,3;0,0015;2000;500;a\n-0,3;-0,001;-2000;500;b\n",
                                         "\xEF\xBB\xBF# a remark\nid\tt_s\tpos_x_mm\tpos_y_mm\tpos_z_mm\r\n7\t0.5\t1.5\t2\t3\r\n9\t0.5\t-1\t-2\t-3\r\n",
                                         "  time [s]  ID   X [mm]   Y [mm]  Z [mm]\n\n  5e-1 7 1.5 2 3\n  5e-1 9 -1 -2 -3\n",
                                         "% made by somebody\n# time_s id x_mm y_mm z_mm\n0.5 7 1.5 2 3\n0.5 9 -1 -2 -3\n",
                                         "\"time [s]\",\"colour\",\"id\",\"x [mm]\",\"y [mm]\",\"z [mm]\",\n0.5,red,7,+1.5,2,3,\n0.5,blue,9,-1,-2,-3,\n"};
    for (const std::string& text : texts) {
        const TrackedParticles read = parse(text);
        ASSERT_EQ(read.frames->frame_count(), 1u) << text;
        const Frame frame = read.frames->frame(0);
        ASSERT_EQ(frame.positions.size(), 2u);
        EXPECT_DOUBLE_EQ(frame.time, 0.5) << text;
        expect_near(frame.positions[0], {1.5e-3, 2e-3, 3e-3}, 1e-15);
        expect_near(frame.positions[1], {-1e-3, -2e-3, -3e-3}, 1e-15);
        EXPECT_EQ(read.summary.tracks, 2u);
    }
    EXPECT_EQ(parse(texts.back()).summary.ignored_columns, std::vector<std::string>{"colour"});
}

TEST(TrackedParticles, UnitsAndFrameRateFromTheSettings) {
    TrackedSettings settings = spheres();
    settings.length_unit = "mm";
    settings.frame_rate = 1000.0;
    const TrackedParticles read = parse("frame,id,x,y,z\n100,1,1,2,3\n101,1,2,2,3\n", settings);
    EXPECT_DOUBLE_EQ(read.frames->time(0), 0.1);
    EXPECT_NEAR(read.frames->frame(0).velocities[0].x(), 1.0, 1e-9);  // 1 mm in 1 ms
    settings.time_unit = "s";
    // Velocities without a unit are in the units of length and time.
    EXPECT_DOUBLE_EQ(parse("time,id,x,y,z,vx,vy,vz\n0,1,1,2,3,40,0,0\n", settings).frames->frame(0).velocities[0].x(), 0.04);
}

TEST(TrackedParticles, VelocitiesOfAParabolaAreExactInTheMiddleAndLinearAtTheEnds) {
    // x = 2 t + 3 t², uneven times: the parabola through three points is the motion itself; at the ends the line's error is 3 h.
    std::string text = "time [s],id,x [m],y [m],z [m]\n";
    const std::vector<double> times{0.0, 0.1, 0.25, 0.3};
    for (const double t : times) text += std::to_string(t) + ",1," + std::to_string(2.0 * t + 3.0 * t * t) + ",0,0\n";
    const TrackedParticles read = parse(text);
    EXPECT_FALSE(read.summary.velocities_from_file);
    for (const std::size_t k : {1u, 2u}) EXPECT_NEAR(read.frames->frame(k).velocities[0].x(), 2.0 + 6.0 * times[k], 1e-5) << k;  // six digits in the text
    EXPECT_NEAR(read.frames->frame(0).velocities[0].x(), 2.0 + 3.0 * 0.1, 1e-4);
    EXPECT_NEAR(read.frames->frame(3).velocities[0].x(), 2.0 + 6.0 * 0.3 - 3.0 * 0.05, 1e-4);
}

TEST(TrackedParticles, LostTracksAreCountedAndNotBridged) {
    // Pellet 1 is lost between 0.2 and 0.6 s, pellet 2 is seen once only, pellet 3 always (one of its rows says nan).
    std::string text = "time [s],id,x [m],y [m],z [m]\n";
    for (const int k : {0, 1, 2, 6, 7, 8}) text += "0." + std::to_string(k) + ",1," + std::to_string(k < 5 ? k : 100 + 2 * k) + ",0,0\n";
    text += "0.4,2,5,5,5\n";
    for (int k = 0; k < 9; ++k) text += "0." + std::to_string(k) + ",3," + (k == 4 ? "nan,nan,nan" : "0,0," + std::to_string(k)) + "\n";
    const TrackedParticles read = parse(text);
    EXPECT_EQ(read.summary.rows_without_place, 1u);
    EXPECT_EQ(read.summary.lost, 3u + 1u);
    EXPECT_EQ(read.summary.without_velocity, 1u);
    EXPECT_EQ(read.summary.times, 9u);
    const Frame third = read.frames->frame(2), fourth = read.frames->frame(3), fifth = read.frames->frame(4), seventh = read.frames->frame(6);
    EXPECT_NEAR(third.velocities[0].x(), 10.0, 1e-9) << "from before the gap only";
    EXPECT_NEAR(seventh.velocities[0].x(), 20.0, 1e-9) << "from behind the gap only";
    EXPECT_FALSE(fourth.is_seen(0));
    EXPECT_TRUE(fifth.is_seen(1));
    EXPECT_FALSE(fifth.is_tracked(1));
    EXPECT_FALSE(fifth.is_seen(2));
    EXPECT_NEAR(fourth.velocities[2].z(), 10.0, 1e-9) << "a gap of two steps is bridged";
}

TEST(TrackedParticles, SpinFromQuaternionsAndOrientationFromAnAxis) {
    // Turning about z with 4 rad/s; the velocity is given.
    std::string text = "time [s],id,x [m],y [m],z [m],qw,qx,qy,qz\n";
    for (int k = 0; k < 4; ++k) {
        const double half = 0.5 * 4.0 * 0.1 * k;
        text += "0." + std::to_string(k) + ",1,0,0,0," + std::to_string(std::cos(half)) + ",0,0," + std::to_string(std::sin(half)) + "\n";
    }
    const TrackedParticles turning = parse(text);
    for (std::size_t k = 0; k < 4; ++k) expect_near(turning.frames->frame(k).spins[0], {0.0, 0.0, 4.0}, 1e-4);
    const TrackedParticles lying = parse("time [s],id,x [m],y [m],z [m],axis_x,axis_y,axis_z\n0,1,0,0,0,2,0,0\n");
    expect_near(lying.frames->frame(0).orientations[0] * Vec3::UnitZ(), {1.0, 0.0, 0.0}, 1e-12);
    expect_near(lying.frames->frame(0).spins[0], Vec3::Zero(), 0.0);
}

TEST(TrackedParticles, SizesFromTheFileMakeOneShapeASize) {
    const TrackedParticles read = parse("time [s],id,x [m],y [m],z [m],diameter [mm]\n0,1,0,0,0,3\n0,2,0,0,1,4\n0,3,0,0,2,3\n", TrackedSettings{});
    const TrajectoryHeader& header = read.frames->header();
    ASSERT_EQ(header.shapes.size(), 2u);
    EXPECT_EQ(header.shape_of_body, (std::vector<std::uint32_t>{0, 1, 0}));
    EXPECT_NEAR(header.shapes[1].rigid.mass_properties.volume, std::acos(-1.0) / 6.0 * 64e-9, 1e-20);
}

TEST(TrackedParticles, AxesAndOriginTurnIntoOurFrame) {
    TrackedSettings settings = spheres();
    settings.axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;  // file x is up, file z is the drum's axis
    settings.origin = {0.1, 0.0, 0.0};
    const Frame frame = parse("time [s],id,x [m],y [m],z [m],vx [m/s],vy [m/s],vz [m/s]\n0,1,0.3,2,3,7,8,9\n", settings).frames->frame(0);
    expect_near(frame.positions[0], {2.0, 3.0, 0.2}, 1e-15);
    expect_near(frame.velocities[0], {8.0, 9.0, 7.0}, 1e-15);
}

TEST(TrackedParticles, ATracerNeedsNoIdAndAPlaneNoDepth) {
    const TrackedParticles read = parse("time [s],x [m],z [m]\n0,0,1\n0.1,0,2\n0.2,0,3\n");
    EXPECT_EQ(read.summary.flat, 'y');
    EXPECT_EQ(read.summary.tracks, 1u);
    expect_near(read.frames->frame(1).velocities[0], {0.0, 0.0, 10.0}, 1e-12);
}

TEST(TrackedParticles, ErrorsNameFileLineAndColumn) {
    struct Wrong {
        std::string text;
        int line, column;
        std::string says;
    };
    const std::vector<Wrong> wrongs{
        {"time [s],id,x,y [mm],z [mm]\n0,1,1,1,1\n", 1, 13, "no unit"},
        {"time [s],id,x [kg],y [mm],z [mm]\n0,1,1,1,1\n", 1, 13, "unit of the column"},
        {"time [s],id,x [mm],y [mm],z [mm]\n0,1,1,1,1\n0.1,1,1,oops,1\n", 3, 9, "'oops'"},
        {"time [s],id,x [mm],y [mm],z [mm]\n0,1,1,1\n", 2, 1, "4 cells"},
        {"time [s],id,x [mm],y [mm],z [mm]\n0,1,1,1,inf\n", 2, 9, "no number"},
        {"time [s],id,x [mm],y [mm],z [mm]\n0,1,1,1,1\n0,1,1,1,1\n", 3, 1, "same pellet at the same time"},
        {"time [s],x [mm],y [mm],z [mm]\n0,1,1,1\n0,2,1,1\n", 3, 1, "no column of ids"},
        {"time [s],id,x [mm],X [cm],z [mm]\n0,1,1,1,1\n", 1, 20, "both mean x"},
        {"id,x [mm],y [mm],z [mm]\n1,1,1,1\n", 1, 1, "no column of times"},
        {"frame,id,x [mm],y [mm],z [mm]\n1,1,1,1,1\n", 1, 1, "frames"},
        {"time [s],id,z [mm]\n0,1,1\n", 1, 1, "no columns of places"},
        {"time [s],id,x [mm],y [mm],z [mm],vx [m/s]\n0,1,1,1,1,1\n", 1, 1, "1 of its components"},
        {"time [s],id,x [mm],y [mm],z [mm],qw,qx,qy,qz\n0,1,1,1,1,0,0,0,0\n", 2, 11, "unit quaternion"},
        {"0,1,1,1,1\n", 1, 1, "no line names the columns"},
        {"time [s],id,x [mm],y [mm],z [mm]\n,1,1,1,1\n", 2, 1, "no time"},
        {"time [s],id,x [mm],y [mm],z [mm]\n0,,1,1,1\n", 2, 3, "no id"},
    };
    for (const Wrong& wrong : wrongs) {
        const Error error = error_of([&] { parse(wrong.text); });
        EXPECT_EQ(error.kind(), ErrorKind::bad_input) << wrong.text;
        EXPECT_EQ(error.place().file, "tracks.csv") << wrong.text;
        EXPECT_EQ(error.place().line, wrong.line) << wrong.text << error.what();
        EXPECT_EQ(error.place().column, wrong.column) << wrong.text << error.what();
        EXPECT_NE(std::string(error.what()).find(wrong.says), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty()) << error.what();
    }
    EXPECT_THROW(parse(""), Error);
    EXPECT_THROW(parse("time [s],id,x [mm],y [mm],z [mm]\n"), Error) << "no rows";
    const Error sizeless = error_of([] { parse("time [s],id,x [mm],y [mm],z [mm]\n0,1,1,1,1\n", TrackedSettings{}); });
    EXPECT_NE(sizeless.problem().find("how large"), std::string::npos);
    const Error changing = error_of([] { parse("time [s],id,x [mm],y [mm],z [mm],d [mm]\n0,1,1,1,1,3\n1,1,1,1,1,4\n", TrackedSettings{}); });
    EXPECT_NE(changing.problem().find("changes along its track"), std::string::npos);
}
