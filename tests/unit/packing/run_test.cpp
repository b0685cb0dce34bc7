#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/makers.hpp"
#include "meshes/read_mesh.hpp"
#include "packing/fill_tube.hpp"
#include "packing/stage.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/packing/small_case.hpp"

using namespace pelletlab;
using namespace pelletlab::packing;
using pelletlab::small_case::dumbbell_inputs;
using pelletlab::small_case::tube_case;

namespace {

double value_of(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o.value;
    ADD_FAILURE() << "no observable " << name;
    return not_known;
}

std::string problem_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        return error.problem();
    }
    return "no error";
}

}  // namespace

TEST(DefineSimulation, TakesDensityAndContactsFromTheCase) {
    Case c = tube_case(10);
    c.materials["pellet"].density = 900.0;
    c.contacts["pellet-floor"] = {0.9, 0.1, 0.0};
    const RunInputs inputs = dumbbell_inputs();
    const auto shell = define_wall(c, "shell", {}, "vessel"), floor = define_wall(c, "floor", {}, "vessel");
    EXPECT_EQ(shell.contact.restitution, c.contacts["pellet-vessel"].restitution) << "no row of its own: that of its material";
    EXPECT_EQ(floor.contact.restitution, 0.9) << "a row by the wall's name goes first";
    const auto definition = define_simulation(c, inputs, {});
    const MassProperties& before = inputs.clump.rigid.mass_properties;
    EXPECT_DOUBLE_EQ(definition.templates[0].mass_properties.mass, 900.0 * before.volume);
    EXPECT_DOUBLE_EQ(definition.templates[0].mass_properties.principal_inertia.x(), before.principal_inertia.x() * 900.0 / before.density);
}

TEST(DefineSimulation, NamesWhatIsMissing) {
    Case c = tube_case(10);
    c.contacts.erase("pellet-vessel");
    EXPECT_NE(problem_of([&] { define_wall(c, "shell", {}, "vessel"); }).find("'shell'"), std::string::npos);
    c = tube_case(10);
    c.pellet.material = "gold";
    EXPECT_NE(problem_of([&] { define_simulation(c, dumbbell_inputs(), {}); }).find("'gold'"), std::string::npos);
}

TEST(FillTube, SmallBedComesToRestOnTheFloor) {
    const Case c = tube_case(60);
    std::vector<Frame> frames;
    TrajectoryHeader header;
    std::vector<Progress> told;
    const RunResult result = fill_tube(
        c, dumbbell_inputs(),
        [&](const TrajectoryHeader& h) {
            header = h;
            return FrameSink([&](const Frame& frame) { frames.push_back(frame); });
        },
        [&](const Progress& progress) { told.push_back(progress); });
    EXPECT_EQ(result.observables.status, "complete");
    EXPECT_EQ(value_of(result.observables, "pellets_counted"), 60.0);
    expect_documented(result.observables);
    // A bed of dumbbells in a tube of five diameters packs between a very loose one (the wall costs about 0.1) and the densest conceivable.
    EXPECT_GT(value_of(result.observables, "packing_fraction_mass"), 0.35);
    EXPECT_LT(value_of(result.observables, "packing_fraction_mass"), 0.74);
    // Statics: what the floor does not carry hangs on the shell by friction, and together they carry the bed's weight, so the share lies between 0 and 1.
    EXPECT_GT(value_of(result.observables, "floor_load_share"), 0.3);
    EXPECT_LT(value_of(result.observables, "floor_load_share"), 1.001);
    EXPECT_GT(value_of(result.observables, "touching_neighbours"), 2.0);
    EXPECT_GT(value_of(result.observables, "largest_overlap_ratio"), 0.0);
    EXPECT_LT(value_of(result.observables, "largest_overlap_ratio"), 0.5);
    // Frames: the loose cloud at 0 s, one each 0.01 s, and the bed at rest.
    ASSERT_GT(frames.size(), 5u);
    EXPECT_EQ(frames[0].time, 0.0);
    for (std::size_t k = 1; k + 1 < frames.size(); ++k) EXPECT_NEAR(frames[k].time, 0.01 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(frames.back().time, static_cast<double>(result.steps) * c.time.step, 1e-9);
    EXPECT_EQ(header.walls.size(), 2u);
    EXPECT_EQ(header.shape_of_body.size(), 60u);
    EXPECT_EQ(frames.back().wall_poses.size(), 2u);
    EXPECT_GT(result.pellet_steps_per_second, 0.0);
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.back().stage, "settling");
    EXPECT_EQ(told.back().rate_unit, "pellet-steps/s");
}

TEST(FillTube, SameBitsForOneAndTwoThreads) {
    const Case c = tube_case(40);
    set_thread_count(1);
    const RunResult one = fill_tube(c, dumbbell_inputs(), {}, {});
    set_thread_count(2);
    const RunResult two = fill_tube(c, dumbbell_inputs(), {}, {});
    set_thread_count(0);
    EXPECT_EQ(one.state_hash, two.state_hash);
    EXPECT_EQ(one.steps, two.steps);
    for (std::size_t k = 0; k < one.observables.values.size(); ++k) EXPECT_EQ(one.observables.values[k].value, two.observables.values[k].value);
}

TEST(FillTube, SaysWhenTheBedIsNotAtRest) {
    Case c = tube_case(20);
    c.time.settle_limit = 0.01;
    EXPECT_EQ(fill_tube(c, dumbbell_inputs(), {}, {}).observables.status, "not at rest");
}

TEST(FillTube, RefusesWhatCannotRun) {
    Case c = tube_case(0);
    EXPECT_NE(problem_of([&] { fill_tube(c, dumbbell_inputs(), {}, {}); }).find("pellet.count"), std::string::npos);
    c = tube_case(10);
    c.rig = Rig::drum;
    EXPECT_NE(problem_of([&] { fill_tube(c, dumbbell_inputs(), {}, {}); }).find("not a tube"), std::string::npos);
    c = tube_case(10);
    c.tube.diameter = 3e-3;
    EXPECT_NE(problem_of([&] { fill_tube(c, dumbbell_inputs(), {}, {}); }).find("pellet larger than its tube"), std::string::npos);
    c = tube_case(5000);
    c.tube.height = 0.03;
    EXPECT_NE(problem_of([&] { fill_tube(c, dumbbell_inputs(), {}, {}); }).find("more pellets than fit"), std::string::npos);
}

TEST(FillTube, TakesTheUsersOwnTube) {
    // Shell and floor of the maker, written as one STL in millimetres. 24 facets of a 10 mm tube, higher than the cloud.
    TriangleMesh tube = meshes::make_tube_shell(0.010, 0.0, 0.060, 24);
    const TriangleMesh floor = meshes::make_disc(0.005, 0.0, true, 24);
    const auto offset = static_cast<std::uint32_t>(tube.vertices.size());
    tube.vertices.insert(tube.vertices.end(), floor.vertices.begin(), floor.vertices.end());
    for (const Triangle& face : floor.faces) tube.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("pelletlab_tube_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    meshes::write_stl(tube, folder / "tube.stl", "mm");

    Case c = tube_case(20);
    c.folder = folder.string();
    c.tube.mesh_file = "tube.stl";
    c.tube.mesh_unit = "mm";
    const RunResult result = fill_tube(c, dumbbell_inputs(), {}, {});
    EXPECT_NE(result.observables.status, "not at rest");
    EXPECT_EQ(value_of(result.observables, "pellets_counted"), 20.0);
    c.tube.mesh_unit = "m";
    EXPECT_NE(problem_of([&] { fill_tube(c, dumbbell_inputs(), {}, {}); }).find("tube.diameter"), std::string::npos) << "a tube of 10 m";
    c.tube.mesh_unit = "mm";
    c.pellet.count = 300;
    EXPECT_NE(problem_of([&] { fill_tube(c, dumbbell_inputs(), {}, {}); }).find("mm high"), std::string::npos) << "the cloud is higher than the mesh";
    std::filesystem::remove_all(folder);
}

TEST(RunStage, EndsBetweenStepsWhenInterrupted) {
    // The flag of core/progress cannot be lowered again, so the signal is raised in a process of its own: a fresh one, because a fork of this one would have
    // lost the worker threads that earlier tests started.
    ::testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(
        {
            install_interrupt_handler();
            int frames = 0;
            const auto stop_at_third_frame = [&](const Frame&) {
                if (++frames == 3) std::raise(SIGINT);
            };
            try {
                fill_tube(tube_case(20), dumbbell_inputs(), [&](const TrajectoryHeader&) { return FrameSink(stop_at_third_frame); }, {});
            } catch (const Error& error) {
                std::exit(error.exit_code());
            }
            std::exit(frames == 3 ? 0 : 1);
        },
        ::testing::ExitedWithCode(130), "");
}
