#include "experiments/attrition_tester.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/find.hpp"
#include "tests/unit/packing/kept_run.hpp"
#include "tests/unit/packing/small_case.hpp"

using namespace pelletlab;
using namespace pelletlab::experiments;
using pelletlab::small_case::dumbbell_inputs;

namespace {

Case small_tester(std::uint32_t count = 60) {
    Case c = small_case::base_case();
    c.rig = Rig::tester;
    c.pellet.count = count;
    c.tester.diameter = 0.05;
    c.tester.length = 0.012;
    c.tester.baffle_height = 0.012;
    c.tester.baffle_thickness = 0.001;
    c.tester.speed = 12.0;
    c.tester.facets = 48;
    c.time.settle_limit = 0.1;
    c.time.spin_up = 0.1;
    c.time.measure = 1.06;  // two turns are 1.0472 s
    c.output.frame_interval = 0.0073;
    c.measurement.velocity_grid = 0.005;
    return c;
}

}  // namespace

TEST(AttritionTester, LiftsPelletsOnTheBaffleAndDropsThem) {
    const Case c = small_tester();
    std::vector<std::string> walls;
    Frame last;
    const auto result = run_tester(c, dumbbell_inputs(),
                                   [&](const TrajectoryHeader& header) {
                                       for (const WallShape& wall : header.walls) walls.push_back(wall.name);
                                       return packing::FrameSink([&](const Frame& frame) { last = frame; });
                                   },
                                   {});
    expect_documented(result.observables);
    EXPECT_EQ(walls, wall_names(c)) << "the names that contact rows may have";
    EXPECT_EQ(result.observables.status, "complete");
    EXPECT_NEAR(find(result.observables, "turns_measured").value, 2.0, 1e-9);
    EXPECT_EQ(result.observables.maps.size(), 8u);
    // A baffle of a quarter of the diameter lifts a good part of 60 pellets and loses them somewhere on the way up or over the top.
    EXPECT_GT(find(result.observables, "baffle_load_largest").value, 5.0);
    EXPECT_GT(find(result.observables, "release_angle").value, 45.0);
    EXPECT_LT(find(result.observables, "release_angle").value, 270.0);
    // Collisions of each kind; the spectrum is all of them.
    for (const char* kind : {"_pellets", "_wall", "_baffle"}) {
        const double rate = find(result.observables, std::string("collision_rate") + kind).value;
        EXPECT_GT(rate, 0.0) << kind;
        double sum = 0.0;
        for (const double part : profile_of(result.observables, std::string("spectrum_impact_energy") + kind).value) sum += part;
        EXPECT_NEAR(sum, rate, 1e-9 * rate) << kind;
        // No fall in the drum is higher than its diameter, so no mean impact costs more than m g D and the speed of its rim.
        const double mass = dumbbell_inputs().clump.rigid.mass_properties.mass, rim = c.tester.speed * 0.5 * c.tester.diameter;
        EXPECT_LT(find(result.observables, std::string("mean_impact_energy") + kind).value, 1e6 * mass * (9.81 * c.tester.diameter + 0.5 * rim * rim)) << kind;
    }
    // The walls turn together, by ω t since the rotation began.
    EXPECT_TRUE(last.wall_poses[3].orientation.isApprox(last.wall_poses[0].orientation, 1e-12));
}

TEST(AttritionTester, SameBitsForOneAndTwoThreadsAndFromAnyCheckpoint) {
    Case c = small_tester(40);
    c.time.settle_limit = 0.05;
    c.time.spin_up = 0.05;
    c.time.measure = 0.55;
    std::vector<Frame> frames;
    std::vector<packing::RunCheckpoint> checkpoints;
    set_thread_count(1);
    const auto whole = run_tester(
        c, dumbbell_inputs(), [&](const TrajectoryHeader&) { return kept_run::into(frames); }, {}, kept_run::keep_every(130, checkpoints));
    set_thread_count(2);
    ASSERT_GE(checkpoints.size(), 4u);
    for (std::size_t k = 0; k <= checkpoints.size(); ++k) {
        // The last one begins at the beginning.
        const packing::RunKeeping resume = k < checkpoints.size() ? kept_run::go_on_from(checkpoints[k], frames) : packing::RunKeeping();
        const auto again = run_tester(c, dumbbell_inputs(), {}, {}, resume);
        EXPECT_EQ(again.state_hash, whole.state_hash);
        kept_run::expect_same_values(whole.observables, again.observables);
        ASSERT_EQ(again.observables.profiles.size(), whole.observables.profiles.size());
        for (std::size_t n = 0; n < whole.observables.profiles.size(); ++n)
            EXPECT_EQ(again.observables.profiles[n].axis, whole.observables.profiles[n].axis) << whole.observables.profiles[n].name;
    }
    set_thread_count(0);
}

TEST(AttritionTester, TakesTheUsersOwnDrumAndBaffle) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("pelletlab_tester_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    Case c = small_tester(20);
    c.time.measure = 0.53;
    c.folder = folder.string();
    meshes::write_stl(meshes::joined(meshes::make_drum_shell(0.05, 0.012, 40),
                                     meshes::joined(meshes::make_drum_end(0.05, -0.006, true, 40), meshes::make_drum_end(0.05, 0.006, false, 40))),
                      folder / "drum.stl", "mm");
    meshes::write_stl(meshes::make_baffle(0.05, 0.012, 0.012, 0.002, c.tester.baffle_start), folder / "baffle.stl", "mm");
    c.tester.mesh_file = "drum.stl";
    c.tester.baffle_mesh_file = "baffle.stl";
    c.tester.mesh_unit = "mm";
    EXPECT_GT(find(run_tester(c, dumbbell_inputs(), {}, {}).observables, "collision_rate_baffle").value, 0.0);
    c.tester.mesh_unit = "m";
    EXPECT_THROW(run_tester(c, dumbbell_inputs(), {}, {}), Error) << "a drum of 50 m";
    std::filesystem::remove_all(folder);
}

TEST(AttritionTester, AWallOfTheCaseDoesNotHideTheBaffle) {
    Case c = small_tester(30);
    c.time.measure = 0.53;
    c.walls["plate"].point = {0.0, 0.0, -0.03};  // below the drum: touches nothing
    EXPECT_GT(find(run_tester(c, dumbbell_inputs(), {}, {}).observables, "collision_rate_baffle").value, 0.0);
}

TEST(AttritionTester, RefusesABaffleAmongTheLoosePellets) {
    Case c = small_tester();
    c.tester.baffle_start = 0.0;
    EXPECT_THROW(run_tester(c, dumbbell_inputs(), {}, {}), Error);
    c.rig = Rig::drum;
    EXPECT_THROW(run_tester(c, dumbbell_inputs(), {}, {}), Error);
}

TEST(AttritionTester, CollisionsAreCountedTurnByTurn) {
    // Ten pellets; 30 events of 1 uJ in the first turn of 2 s, 50 in the second.
    std::vector<solver::ContactEvents> records(3);
    const std::size_t bin = solver::spectrum_bin(1e-6);
    const std::array<double, 3> events{0.0, 30.0, 80.0};
    for (std::size_t k = 0; k < 3; ++k) {
        records[k].complete = events[k];
        records[k].dissipated = 2e-6 * events[k];
        records[k].dissipated_complete = 1.5e-6 * events[k];
        records[k].spectra[0].count[bin] = events[k];
        records[k].spectra[0].energy[bin] = 1e-6 * events[k];
    }
    Observables result;
    add_collisions(result, "pellets", records, 2.0, 10, {0.0, 4.0});
    EXPECT_NEAR(find(result, "collision_rate_pellets").value, 0.5 * (30.0 + 50.0) / 2.0 / 10.0, 1e-12);
    EXPECT_NEAR(find(result, "collision_rate_pellets").standard_error, 0.5, 1e-12);  // 1.5 and 2.5: s = √½, s/√2
    EXPECT_NEAR(find(result, "mean_impact_energy_pellets").value, 1.0, 1e-12);
    EXPECT_NEAR(find(result, "dissipated_power_pellets").value, 0.5 * (0.03 + 0.05), 1e-12);  // mW
    EXPECT_NEAR(find(result, "dissipated_in_collisions_pellets").value, 0.75, 1e-12);
    const Profile& spectrum = profile_of(result, "spectrum_impact_energy_pellets");
    ASSERT_EQ(spectrum.axis.size(), 1u);
    EXPECT_NEAR(spectrum.value[0], 2.0, 1e-12);
    EXPECT_NEAR(std::log10(spectrum.axis[0]), 0.0, 1.0 / 8.0);
    expect_documented(result);
}
