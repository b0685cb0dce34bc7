// The same 1000 pellets of 24 spheres fall from the same places into the same 52 mm tube as in LIGGGHTS-PUBLIC 3.8.0 (input, initial and final states:
// ../shared/peers/xval; conditions: ../shared/design/peers.md, section 6). Equal laws, but not equal arithmetic: a bed of colliding pellets is chaotic, so
// figures of the bed are compared, not places of pellets.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "meshes/makers.hpp"
#include "observables/bed.hpp"
#include "packing/stage.hpp"
#include "solver/simulation.hpp"

using namespace pelletlab;

namespace {

constexpr double pi = std::numbers::pi;
const std::filesystem::path folder = std::filesystem::path(PELLETLAB_SHARED_DIR) / "peers" / "xval";

/// LIGGGHTS' figures of its final state, peers.md section 6.
struct Reference {
    double h95 = 17.338, h100 = 18.704, grid = 15.527, centroid = 8.590, core = 0.6740, alignment = 0.5122, packing_h95 = 0.6146;
};

RigidTemplate study_pellet() {
    RigidTemplate pellet;
    pellet.name = "study pellet, 24 spheres";
    std::ifstream file(folder / "clump24.txt");
    double x = 0.0, y = 0.0, z = 0.0, r = 0.0;
    while (file >> x >> y >> z >> r) pellet.spheres.push_back({Vec3(x, y, z) * 1e-3, r * 1e-3});
    MassProperties& mass = pellet.mass_properties;  // of the true cylinder, as given to LIGGGHTS
    mass.volume = pi * 0.25 * 3.12e-3 * 3.12e-3 * 2.96e-3;
    mass.density = 1800.0;
    mass.mass = 4.073458401e-05;
    mass.principal_inertia = {5.452459852e-11, 5.452459852e-11, 4.956584182e-11};
    pellet.bounding_radius = bounding_radius(pellet.spheres);
    return pellet;
}

/// Rows x,y,z, axis a (template z), direction e (template x).
std::vector<Pose> read_poses(const char* name) {
    std::vector<Pose> poses;
    std::ifstream file(folder / name);
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        for (char& c : line)
            if (c == ',') c = ' ';
        std::istringstream numbers(line);
        Vec3 p, a, e;
        numbers >> p.x() >> p.y() >> p.z() >> a.x() >> a.y() >> a.z() >> e.x() >> e.y() >> e.z();
        a.normalize();
        e = (e - a * a.dot(e)).normalized();
        Mat3 rotation;
        rotation << e, a.cross(e), a;
        poses.push_back({p, Quat(rotation).normalized()});
    }
    return poses;
}

Observables measure(const RigidTemplate& pellet, const std::vector<Pose>& poses) {
    Trajectory trajectory;
    trajectory.head.shapes = {{pellet, {}}};
    trajectory.head.shape_of_body.assign(poses.size(), 0);
    Frame frame;
    for (const Pose& pose : poses) {
        frame.positions.push_back(pose.position);
        frame.orientations.push_back(pose.orientation);
    }
    trajectory.frames = {frame};
    return observables::measure_tube_bed(trajectory, {26e-3, 0.0, 1e-3, 2e-3});
}

double value_of(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o.value;
    ADD_FAILURE() << "no observable " << name;
    return not_known;
}

solver::SimulationDefinition tube_case(const RigidTemplate& pellet) {
    solver::SimulationDefinition definition;
    definition.templates = {pellet};
    definition.pellet_material = {2e6, 0.25};  // E = 2 G (1 + ν) = 5e6 Pa, walls too
    definition.pellet_contact = {0.4, 0.7, 0.05};
    const auto wall = [&](const char* name, TriangleMesh mesh) {
        solver::WallDefinition w;
        w.name = name;
        w.mesh = std::move(mesh);
        w.material = definition.pellet_material;
        w.contact = definition.pellet_contact;
        definition.walls.push_back(std::move(w));
    };
    wall("shell", meshes::make_tube_shell(52e-3, 0.0, 54e-3, 48));
    wall("floor", meshes::make_disc(26e-3, 0.0, true, 48));
    definition.time_step = 1e-5;
    return definition;
}

class TubeAgainstLiggghts : public ::testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(folder / "tube1000x24_initial.csv")) GTEST_SKIP() << "the reference states are not there: ../shared/peers/xval";
    }
};

}  // namespace

TEST_F(TubeAgainstLiggghts, OurMeasurementOfTheirFinalStateGivesTheirFigures) {
    const Observables bed = measure(study_pellet(), read_poses("tube1000x24_final.csv"));
    const Reference reference;
    // The reference is printed with three or four decimals, the states with 1e-8 m.
    EXPECT_NEAR(value_of(bed, "bed_height_h95"), reference.h95, 6e-4);
    EXPECT_NEAR(value_of(bed, "bed_height_h100"), reference.h100, 6e-4);
    EXPECT_NEAR(value_of(bed, "bed_height_grid"), reference.grid, 6e-4);
    EXPECT_NEAR(value_of(bed, "mean_centroid_height"), reference.centroid, 6e-4);
    EXPECT_NEAR(value_of(bed, "packing_fraction_core"), reference.core, 6e-5);
    EXPECT_NEAR(value_of(bed, "packing_fraction_h95"), reference.packing_h95, 6e-5);
    EXPECT_NEAR(value_of(bed, "mean_axis_alignment"), reference.alignment, 6e-5);
}

TEST_F(TubeAgainstLiggghts, FillingFromTheSameStateGivesTheSameBed) {
    const RigidTemplate pellet = study_pellet();
    solver::Simulation simulation(tube_case(pellet));
    std::vector<solver::BodyPlacement> bodies;
    for (const Pose& pose : read_poses("tube1000x24_initial.csv")) bodies.push_back({0, pose, Vec3::Zero(), Vec3::Zero()});
    simulation.add_bodies(bodies);

    packing::RunMeter meter;
    packing::Stage fall;
    fall.name = "falling";
    fall.duration = 0.40;  // at rest since 0.35 s; LIGGGHTS ran 0.61 s
    fall.watch_interval = 0.05;
    fall.watch = [](const solver::Simulation& now) {
        const solver::EnergyReport energy = now.energy();
        const solver::ContactSummary contacts = now.contacts();
        std::printf("t %.2f s  kinetic energy %.2e + %.2e J  pair contacts %.3f a pellet, wall %.3f  largest overlap/radius %.3f\n", now.time(),
                    energy.kinetic_translation, energy.kinetic_rotation, static_cast<double>(contacts.sphere_contacts) / 1000.0,
                    static_cast<double>(contacts.wall_contacts) / 1000.0, contacts.largest_overlap_ratio);
        return false;
    };
    packing::run_stage(simulation, fall, {}, {}, meter);

    std::vector<Pose> poses;
    for (std::size_t i = 0; i < simulation.bodies().size(); ++i) poses.push_back({simulation.bodies().position[i], simulation.bodies().orientation[i]});
    const Observables bed = measure(pellet, poses);
    for (const Observable& o : bed.values) std::printf("%-24s %10.4f %s\n", o.name.c_str(), o.value, o.unit.c_str());
    std::printf("%.3g pellet-steps/s\n", meter.pellet_steps_per_second(poses.size()));

    // One run of each code, seen: h95 17.25 against 17.34 mm, centroid 8.560 against 8.590 mm, packing 0.618 against 0.615. 2 % on heights and packing is
    // agreement (the reference states that its own scatter is not known); the alignment of 1000 axes scatters by 0.009.
    const Reference reference;
    EXPECT_NEAR(value_of(bed, "bed_height_h95"), reference.h95, 0.02 * reference.h95);
    EXPECT_NEAR(value_of(bed, "bed_height_grid"), reference.grid, 0.02 * reference.grid);
    EXPECT_NEAR(value_of(bed, "mean_centroid_height"), reference.centroid, 0.015 * reference.centroid);
    EXPECT_NEAR(value_of(bed, "packing_fraction_h95"), reference.packing_h95, 0.02 * reference.packing_h95);
    EXPECT_NEAR(value_of(bed, "packing_fraction_core"), reference.core, 0.03 * reference.core);
    EXPECT_NEAR(value_of(bed, "mean_axis_alignment"), reference.alignment, 4 * 0.009);
    EXPECT_EQ(value_of(bed, "pellets_counted"), 1000.0);
    const solver::EnergyReport energy = simulation.energy();
    EXPECT_LT(energy.kinetic_translation + energy.kinetic_rotation, 1e-8) << "the bed is not at rest (1e-11 J a pellet is 7e-6 of m g d)";
}
