// Exact walls of a case: what the solver gets, and that pellets feel them.
#include "packing/extra_walls.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <new>

#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "packing/fill_tube.hpp"
#include "packing/run_frames.hpp"
#include "tests/unit/packing/small_case.hpp"

using namespace pelletlab;
using solver::ExactSurface;

namespace {

ExtraWall wall(const char* shape, const Vec3& point) {
    ExtraWall w;
    w.shape = shape, w.point = point, w.axis = {0.0, 0.0, 4.0};
    w.radius = 3e-3, w.far_radius = 1e-3, w.length = 5e-3, w.size = {1e-3, 2e-3, 4e-3};
    return w;
}

double value_of(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o.value;
    ADD_FAILURE() << "no observable " << name;
    return not_known;
}

}  // namespace

TEST(ExtraWalls, HaveExactSurfacesAndMeshesOfTheSameSize) {
    Case c = small_case::tube_case(5);
    const Vec3 p(1e-3, -2e-3, 3e-3);
    for (const char* shape : {"plane", "disc", "cylinder", "cone", "box"}) c.walls[shape] = wall(shape, p);
    std::vector<solver::WallDefinition> walls = {packing::define_wall(c, "shell", meshes::make_tube_shell(0.01, 0.0, 0.05, 24), "vessel")};
    packing::add_walls_of_case(c, walls);
    ASSERT_EQ(walls.size(), 6u);
    walls.erase(walls.begin());
    for (const solver::WallDefinition& w : walls) {
        EXPECT_NE(w.exact.kind, ExactSurface::Kind::none) << w.name;
        EXPECT_EQ(w.contact.restitution, c.contacts["pellet-vessel"].restitution);
        const Box box = bounding_box(w.mesh);
        Vec3 size(6e-3, 6e-3, 5e-3), centre = p + Vec3(0.0, 0.0, 2.5e-3);
        if (w.name == "plane" || w.name == "disc") size.z() = 0.0, centre = p;
        if (w.name == "box") size = c.walls["box"].size, centre = p;
        if (w.name == "plane") {
            EXPECT_LT(box.sizes().z(), 1e-12);
            EXPECT_NEAR(box.center().z(), p.z(), 1e-12);
            EXPECT_GT(box.sizes().x(), 0.1);  // it has no end: wider than the tube is high
            continue;
        }
        EXPECT_LT((box.sizes() - size).norm(), 1e-5) << w.name;  // 96 facets of the circle
        EXPECT_LT((box.center() - centre).norm(), 1e-5) << w.name;
    }
}

TEST(ExtraWalls, SurfacesHaveNoNumbersThatWereNeverSet) {
    // Built on memory full of NaN: every member of every kind must be a number.
    alignas(ExactSurface) unsigned char memory[sizeof(ExactSurface)];
    const auto check = [&](auto make) {
        std::memset(memory, 0xff, sizeof memory);
        const auto* s = new (memory) ExactSurface(make());
        EXPECT_TRUE(s->point.allFinite() && s->axis.allFinite() && s->start.allFinite() && s->end.allFinite() && s->half_size.allFinite());
    };
    check([] { return solver::exact_plane(Vec3::Zero(), Vec3::UnitY()); });
    check([] { return solver::exact_cylinder(Vec3::Zero(), Vec3::UnitY(), 1.0, 0.0, 1.0); });
    check([] { return solver::exact_disc(Vec3::Zero(), Vec3::UnitY(), 1.0); });
    check([] { return solver::exact_box(-Vec3::Ones(), Vec3::Ones()); });
    check([] { return ExactSurface(); });
}

TEST(ExtraWalls, APlaneUnderTheBedIsItsFloor) {
    Case c = small_case::tube_case(30);
    const auto bottom = [&c] {
        double lowest = 1.0;
        packing::fill_tube(c, small_case::dumbbell_inputs(),
                           [&](const TrajectoryHeader&) {
                               return [&](const Frame& f) {
                                   lowest = 1.0;
                                   for (const Vec3& p : f.positions) lowest = std::min(lowest, p.z());
                               };
                           },
                           {});
        return lowest;
    };
    c.tube.surface = "exact";
    const double exact = bottom();
    EXPECT_GT(exact, 0.6e-3);
    EXPECT_LT(exact, 1.6e-3);  // a dumbbell lies or stands: 0.75 or 1.5 mm
    c.gravity = {0.0, 0.0, -9.81};
    c.walls["plate"] = wall("plane", {0.0, 0.0, -1e-3});  // under the floor: touches nothing
    EXPECT_EQ(bottom(), exact);
}

TEST(ExtraWalls, ReachUpToTheirHighestPointOverTheTube) {
    Case c = small_case::tube_case(5);
    const Vec3 p(1e-3, -2e-3, 3e-3);
    const auto top = [&](ExtraWall w) {
        c.walls["one"] = std::move(w);
        return packing::top_of_extra_walls(c, 5e-3);
    };
    EXPECT_DOUBLE_EQ(top(wall("plane", p)), 3e-3);
    EXPECT_DOUBLE_EQ(top(wall("disc", p)), 3e-3);
    EXPECT_DOUBLE_EQ(top(wall("cylinder", p)), 8e-3);
    EXPECT_DOUBLE_EQ(top(wall("cone", p)), 8e-3);
    EXPECT_DOUBLE_EQ(top(wall("box", p)), 5e-3);
    ExtraWall tilted = wall("plane", p);
    tilted.axis = {-2.0, 0.0, -2.0};  // z = 3 mm − (x − 1 mm): 9 mm at x = −5 mm
    EXPECT_NEAR(top(tilted), 9e-3, 1e-15);
    tilted.axis = Vec3::UnitX();
    EXPECT_EQ(top(tilted), 0.0);
    ExtraWall level = wall("cylinder", p);
    level.axis = Vec3::UnitX();
    EXPECT_DOUBLE_EQ(top(level), 6e-3);
    EXPECT_EQ(top(wall("box", {0.0, 0.0, -5e-3})), 0.0);
}

TEST(ExtraWalls, ACloudStartsAboveAConeAndNoPelletEndsInIt) {
    Case c = small_case::tube_case(40);
    ExtraWall cone = wall("cone", Vec3::Zero());
    cone.radius = 4e-3, cone.far_radius = 0.0, cone.length = 4e-3;
    c.walls["hill"] = cone;
    std::vector<Frame> frames;
    packing::fill_tube(c, small_case::dumbbell_inputs(), [&](const TrajectoryHeader&) { return [&](const Frame& f) { frames.push_back(f); }; }, {});
    for (const Vec3& p : frames.front().positions) EXPECT_GT(p.z(), 4e-3 + 1.5e-3 - 1e-9);  // bounding spheres stand on the tip's level
    double lowest = 1.0;
    for (const Vec3& p : frames.back().positions) {
        EXPECT_GT(p.z() + p.head<2>().norm(), 4e-3) << "a centre inside the cone";
        lowest = std::min(lowest, p.z());
    }
    EXPECT_LT(lowest, 3e-3);  // they fill the groove around it
    c.tube.height = 6e-3;
    EXPECT_THROW(packing::fill_tube(c, small_case::dumbbell_inputs(), {}, {}), Error);
}

TEST(ExtraWalls, SayWhatTurns) {
    Case c = small_case::drum_case(5);
    c.walls["lifter"] = wall("box", Vec3::Zero());
    c.walls["lifter"].turns = true;
    c.walls["fin"] = wall("box", Vec3::Zero());
    c.drum.end_plates_rotate = false;
    EXPECT_TRUE(packing::turns_with_vessel(c, "shell"));
    EXPECT_FALSE(packing::turns_with_vessel(c, "front"));
    EXPECT_TRUE(packing::turns_with_vessel(c, "lifter"));
    EXPECT_FALSE(packing::turns_with_vessel(c, "fin"));
    c.drum.end_plates_rotate = true;
    EXPECT_TRUE(packing::turns_with_vessel(c, "back"));
    EXPECT_FALSE(packing::turns_with_vessel(c, "fin"));
}

TEST(ExtraWalls, ExactTubeAndFineFacetsHoldTheSameBed) {
    Case c = small_case::tube_case(60);
    const auto height = [&c] {
        const packing::RunResult result = packing::fill_tube(c, small_case::dumbbell_inputs(), {}, {});
        return value_of(result.observables, "mean_centroid_height");
    };
    c.tube.facets = 720;
    const double facets = height();
    c.tube.surface = "exact";
    EXPECT_NEAR(height(), facets, 0.1 * facets);  // two beds of a chaotic fall
}
