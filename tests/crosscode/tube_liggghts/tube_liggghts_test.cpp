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

#include "core/random.hpp"
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

/// Settles the reference column, every pellet moved by up to a micrometre: `seed` 0 moves none. Prints what it measures.
Observables settle_column(const RigidTemplate& pellet, std::uint64_t seed) {
    solver::Simulation simulation(tube_case(pellet));
    std::vector<solver::BodyPlacement> bodies;
    for (Pose pose : read_poses("tube1000x24_initial.csv")) {
        RandomStream random(seed, bodies.size());
        if (seed > 0) pose.position += Vec3(random.uniform(-1e-6, 1e-6), random.uniform(-1e-6, 1e-6), random.uniform(-1e-6, 1e-6));
        bodies.push_back({0, pose, Vec3::Zero(), Vec3::Zero()});
    }
    simulation.add_bodies(bodies);
    packing::Stage fall;
    fall.name = "falling";
    fall.duration = 0.61;  // as long as LIGGGHTS ran; most are at rest after 0.35 s
    fall.watch_interval = 0.01;
    fall.watch = [](const solver::Simulation& now, std::vector<double>&) {
        const solver::EnergyReport e = now.energy();
        return now.time() > 0.3 && e.kinetic_translation + e.kinetic_rotation < 1e-9;
    };
    packing::Course course(simulation, {});
    course.run(fall);

    std::vector<Pose> poses;
    for (std::size_t i = 0; i < simulation.bodies().size(); ++i) poses.push_back({simulation.bodies().position[i], simulation.bodies().orientation[i]});
    Observables bed = measure(pellet, poses);
    const solver::ContactSummary contacts = simulation.contacts();
    bed.values.push_back({"contacts_per_pellet", "1", static_cast<double>(contacts.sphere_contacts) / 1000.0, not_known, {}, ""});
    std::printf("seed %d:", static_cast<int>(seed));
    for (const char* name : {"bed_height_h95", "bed_height_grid", "mean_centroid_height", "packing_fraction_h95", "packing_fraction_core",
                             "mean_axis_alignment", "contacts_per_pellet"})
        std::printf(" %s %.4f", name, value_of(bed, name));
    std::printf(", %.2g pellet-steps/s\n", course.meter.pellet_steps_per_second(poses.size()));
    std::fflush(stdout);
    EXPECT_EQ(value_of(bed, "pellets_counted"), 1000.0);
    const solver::EnergyReport energy = simulation.energy();
    EXPECT_LT(energy.kinetic_translation + energy.kinetic_rotation, 1e-8) << "the bed is not at rest (1e-11 J a pellet is 7e-6 of m g d)";
    return bed;
}

TEST_F(TubeAgainstLiggghts, TheirBedLiesWithinTheScatterOfOurs) {
    // A bed of colliding pellets is chaotic: a micrometre at the start gives another bed of the same kind. Six of ours (the very state, and five moved ones)
    // tell how much such beds differ; LIGGGHTS' one bed must look like one of them. For one more value of the same normal distribution, (x - mean) / (s sqrt(1
    // + 1/6)) follows Student's t with 5 degrees of freedom: 4.03 is passed by one figure in a hundred.
    const RigidTemplate pellet = study_pellet();
    std::vector<Observables> beds;
    for (const std::uint64_t seed : {0, 1, 2, 3, 4, 5}) beds.push_back(settle_column(pellet, seed));
    const Reference reference;
    struct Figure {
        const char* name;
        double theirs, most;  ///< most: what the scatter may excuse at the very most, relative
    };
    for (const Figure& figure : {Figure{"bed_height_h95", reference.h95, 0.02}, Figure{"bed_height_grid", reference.grid, 0.02},
                                 Figure{"mean_centroid_height", reference.centroid, 0.015}, Figure{"packing_fraction_h95", reference.packing_h95, 0.02},
                                 Figure{"packing_fraction_core", reference.core, 0.03}, Figure{"mean_axis_alignment", reference.alignment, 0.06},
                                 Figure{"contacts_per_pellet", 2.75, 0.06}}) {
        const double n = static_cast<double>(beds.size());
        double mean = 0.0, variance = 0.0;
        for (const Observables& bed : beds) mean += value_of(bed, figure.name) / n;
        for (const Observables& bed : beds) variance += std::pow(value_of(bed, figure.name) - mean, 2) / (n - 1.0);
        const double t = (figure.theirs - mean) / std::sqrt(variance * (1.0 + 1.0 / n));
        std::printf("%-24s ours %.4f +- %.4f (one bed)  LIGGGHTS %.4f  t = %.2f  %+.2f %%\n", figure.name, mean, std::sqrt(variance), figure.theirs, t,
                    100.0 * (figure.theirs / mean - 1.0));
        EXPECT_LT(std::abs(t), 4.03) << figure.name;
        EXPECT_NEAR(mean, figure.theirs, figure.most * figure.theirs) << figure.name;
    }
}
