#include "experiments/sandpile.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "packing/funnel.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/find.hpp"
#include "tests/unit/packing/kept_run.hpp"
#include "tests/unit/packing/small_case.hpp"

using namespace pelletlab;
using namespace pelletlab::experiments;
using pelletlab::kept_run::into;
using pelletlab::small_case::dumbbell_inputs;

namespace {

/// A hundred dumbbells of 3 mm through an outlet of 12 mm.
Case small_pile(const std::string& release, std::uint32_t count = 100) {
    Case c = small_case::base_case();
    c.rig = Rig::pile;
    c.pellet.count = count;
    c.contacts["pellet-pellet"] = {0.4, 0.7, 0.1};
    c.contacts["pellet-vessel"] = {0.4, 0.7, 0.1};
    c.pile.release = release;
    c.pile.plate_diameter = 0.2;
    c.pile.cylinder_diameter = 0.012;
    c.pile.lift_speed = 0.1;
    c.pile.discharge_limit = 1.5;
    c.funnel.outlet_diameter = 0.012;
    c.funnel.top_diameter = 0.024;
    c.funnel.outlet_height = 0.025;
    c.funnel.facets = 32;
    c.time.settle_limit = 0.3;
    c.time.rest_kinetic_energy = 1e-4;
    c.output.frame_interval = 0.05;
    return c;
}

}  // namespace

TEST(Sandpile, PoursAllPelletsThroughTheFunnelOntoThePlate) {
    const Case c = small_pile("funnel");
    std::vector<Frame> frames;
    std::vector<std::string> walls;
    const auto result = run_pile(c, dumbbell_inputs(),
                                 [&](const TrajectoryHeader& header) {
                                     for (const WallShape& wall : header.walls) walls.push_back(wall.name);
                                     return into(frames);
                                 },
                                 {});
    expect_documented(result.observables);
    EXPECT_EQ(walls, (std::vector<std::string>{"plate", "tray", "funnel", "shutter"}));
    EXPECT_EQ(walls, wall_names(c)) << "the names that contact rows may have";
    EXPECT_EQ(find(result.observables, "pellets_above").value, 0.0);
    EXPECT_EQ(find(result.observables, "pellets_counted").value + find(result.observables, "pellets_off_plate").value, 100.0);
    EXPECT_EQ(find(result.observables, "pellets_off_plate").value, 0.0);
    // Nothing leaves a closed funnel: as long as it settles, all pellets are above the outlet.
    const double opened = find(result.observables, "discharge_time").window.begin;
    for (const Frame& frame : frames) {
        if (frame.time > opened) continue;
        for (const Vec3& p : frame.positions) EXPECT_GT(p.z(), c.funnel.outlet_height) << frame.time;
    }
    // The first pellet falls 25 mm in 0.07 s; Beverloo's law for 12 mm lets 100 pellets out in some tenths of a second.
    EXPECT_GT(find(result.observables, "discharge_time").value, 0.05);
    EXPECT_LT(find(result.observables, "discharge_time").value, 1.0);
    EXPECT_GT(find(result.observables, "run_out_95").value, 3.0);
    // The shutter has slid aside by 1.2 outlets.
    EXPECT_NEAR(frames.back().wall_poses[3].position.x(), 1.2 * c.funnel.outlet_diameter, 1e-12);
}

TEST(Sandpile, LiftsTheCylinderAtItsSpeed) {
    const Case c = small_pile("cylinder", 60);
    std::vector<Frame> frames;
    const auto result = run_pile(c, dumbbell_inputs(), [&](const TrajectoryHeader&) { return into(frames); }, {});
    expect_documented(result.observables);
    EXPECT_EQ(find(result.observables, "pellets_counted").value, 60.0);
    std::vector<const Frame*> moving;
    for (const Frame& frame : frames)
        if (frame.wall_poses[2].position.z() > 0.0 && frame.wall_poses[2].position.z() < frames.back().wall_poses[2].position.z()) moving.push_back(&frame);
    ASSERT_GE(moving.size(), 3u);
    for (std::size_t k = 1; k < moving.size(); ++k)
        EXPECT_NEAR(moving[k]->wall_poses[2].position.z() - moving[k - 1]->wall_poses[2].position.z(),
                    c.pile.lift_speed * (moving[k]->time - moving[k - 1]->time), 1e-9);
    double top = 0.0;
    for (const Vec3& p : frames.back().positions) top = std::max(top, p.z());
    EXPECT_GT(frames.back().wall_poses[2].position.z(), top) << "the cylinder is clear of the pile";
}

TEST(Sandpile, WithoutFrictionThereIsNoPile) {
    Case c = small_pile("funnel", 60);
    c.contacts["pellet-pellet"] = {0.4, 0.0, 0.0};
    c.contacts["pellet-vessel"] = {0.4, 0.0, 0.0};
    c.pile.plate_diameter = 0.05;
    c.pile.discharge_limit = 1.0;
    const auto result = run_pile(c, dumbbell_inputs(), {}, {});
    EXPECT_TRUE(result.observables.status == "no pile" || result.observables.status == "not discharged") << result.observables.status;
    EXPECT_GT(find(result.observables, "pellets_off_plate").value, 20.0) << "what slides off the plate lies in the tray";
}

TEST(Sandpile, AClosedTimeOrAClogIsAStatus) {
    Case c = small_pile("funnel", 40);
    c.pile.discharge_limit = 0.02;
    c.funnel.outlet_height = 0.05;
    EXPECT_EQ(run_pile(c, dumbbell_inputs(), {}, {}).observables.status, "not discharged");
    c.funnel.outlet_diameter = 0.0034;  // a dumbbell of 3 mm bridges it
    c.pile.discharge_limit = 1.0;
    const auto clogged = run_pile(c, dumbbell_inputs(), {}, {});
    EXPECT_TRUE(clogged.observables.status == "not discharged" || clogged.observables.status == "funnel not empty") << clogged.observables.status;
    EXPECT_GT(find(clogged.observables, "pellets_above").value, 10.0);
}

TEST(Sandpile, SameBitsForOneAndTwoThreadsAndFromAnyCheckpoint) {
    Case c = small_pile("funnel", 40);
    c.pile.discharge_limit = 0.3;
    std::vector<Frame> frames;
    std::vector<packing::RunCheckpoint> checkpoints;
    set_thread_count(1);
    const auto whole = run_pile(
        c, dumbbell_inputs(), [&](const TrajectoryHeader&) { return into(frames); }, {}, kept_run::keep_every(150, checkpoints));
    set_thread_count(2);
    EXPECT_EQ(run_pile(c, dumbbell_inputs(), {}, {}).state_hash, whole.state_hash);
    std::set<std::size_t> stages;
    for (const packing::RunCheckpoint& checkpoint : checkpoints) {
        stages.insert(checkpoint.ended.size());
        const auto result = run_pile(c, dumbbell_inputs(), {}, {}, kept_run::go_on_from(checkpoint, frames));
        EXPECT_EQ(result.state_hash, whole.state_hash);
        kept_run::expect_same_values(whole.observables, result.observables);
    }
    set_thread_count(0);
    EXPECT_EQ(stages.size(), 2u) << "checkpoints in settling and discharge";
}

TEST(Sandpile, TakesTheUsersOwnFunnelAndCylinder) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("pelletlab_pile_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    Case c = small_pile("funnel", 30);
    c.folder = folder.string();
    meshes::write_stl(meshes::make_funnel(0.012, 0.024, 0.7, 0.025, 0.045, 20), folder / "funnel.stl", "mm");
    c.funnel.mesh_file = "funnel.stl";
    c.funnel.mesh_unit = "mm";
    EXPECT_EQ(find(run_pile(c, dumbbell_inputs(), {}, {}).observables, "pellets_counted").value, 30.0);
    c.funnel.outlet_height = 0.03;
    EXPECT_THROW(run_pile(c, dumbbell_inputs(), {}, {}), Error) << "its outlet is not there";
    c = small_pile("cylinder", 30);
    c.folder = folder.string();
    meshes::write_stl(meshes::make_tube_shell(0.012, 0.0, 0.02, 20), folder / "cylinder.stl", "mm");
    c.pile.mesh_file = "cylinder.stl";
    c.pile.mesh_unit = "mm";
    EXPECT_EQ(find(run_pile(c, dumbbell_inputs(), {}, {}).observables, "pellets_counted").value, 30.0);
    c.pile.mesh_unit = "m";
    EXPECT_THROW(run_pile(c, dumbbell_inputs(), {}, {}), Error) << "a cylinder of 12 m";
    std::filesystem::remove_all(folder);
}

TEST(Sandpile, RefusesACaseOfAnotherRig) {
    Case c = small_pile("funnel", 10);
    c.rig = Rig::tube;
    EXPECT_THROW(run_pile(c, dumbbell_inputs(), {}, {}), Error);
}
