// LIGGGHTS inserts one pellet of the exported template and lets it fly: the mass, inertia and positions it reports are ours, and it turns as our pellet would.
#include <gtest/gtest.h>

#include <sstream>

#include "free_flight.hpp"
#include "program.hpp"

namespace pelletlab::crosscode {
namespace {

constexpr const char* input = R"(atom_style sphere
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region box block -0.02 0.02 -0.02 0.02 -0.02 0.02 units box
create_box 1 box
neighbor 0.0005 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.25
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.4
fix m4 all property/global coefficientFriction peratomtypepair 1 0.7
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-6
include unlike.liggghts.in
region ins block -0.004 0.004 -0.004 0.004 -0.004 0.004 units box
fix ins all insert/pack seed 32452843 distributiontemplate pdd_unlike maxattempt 1000 insert_every once overlapcheck yes orientation constant 0.8 0.0 0.6 0.0 &
  vel constant 0.1 0.05 -0.02 omega constant 60 -40 90 region ins particles_in_region 1
fix integr all multisphere
compute ke all ke/multisphere
compute er all erotate/multisphere
thermo_style custom step atoms c_ke c_er
thermo_modify format float %.15g lost error
thermo 1
run 1
thermo 10000
dump d all custom 25000 run.dump id mol type x y z radius
dump_modify d sort id format "%d %d %d %.15g %.15g %.15g %.15g"
run 50000
)";

struct Frame {
    long step = 0;
    std::vector<Vec3> centres;
    std::vector<double> radii;
};

std::vector<Frame> frames_of(const std::string& dump) {
    std::vector<Frame> frames;
    std::istringstream lines(dump);
    std::string line;
    bool atoms = false;
    while (std::getline(lines, line)) {
        if (line.rfind("ITEM: TIMESTEP", 0) == 0) {
            frames.emplace_back();
            std::getline(lines, line);
            frames.back().step = std::stol(line);
            atoms = false;
        } else if (line.rfind("ITEM:", 0) == 0) {
            atoms = line.rfind("ITEM: ATOMS", 0) == 0;
        } else if (atoms) {
            std::istringstream words(line);
            double id = 0, mol = 0, type = 0, x = 0, y = 0, z = 0, r = 0;
            words >> id >> mol >> type >> x >> y >> z >> r;
            frames.back().centres.emplace_back(x, y, z);
            frames.back().radii.push_back(r);
        }
    }
    return frames;
}

TEST(Liggghts, FliesThePelletWeExported) {
    const std::string program = find_program("liggghts");
    if (program.empty()) GTEST_SKIP() << "liggghts is not installed (Debian package liggghts)";
    const Folder folder;
    const ClumpTemplate clump = unlike_pellet();
    const MassProperties& mass = clump.rigid.mass_properties;
    folder.write(shapegen::formats::find("liggghts").write(clump, {}));
    folder.write("in.run", input);
    ASSERT_EQ(folder.run(program + " -in in.run -log log.txt"), 0) << folder.read("output.txt");

    // What it says of the template, printed with seven digits.
    const std::string log = folder.read("log.txt");
    const std::vector<double> said_mass = numbers_after(log, "   mass = "), said_inertia = numbers_after(log, "Principal moments of inertia_: ");
    ASSERT_GE(said_mass.size(), 1U) << log;
    ASSERT_EQ(said_inertia.size(), 3U);
    EXPECT_NEAR(said_mass[0] / mass.mass, 1.0, 1e-6);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(said_inertia[static_cast<std::size_t>(k)] / mass.principal_inertia[k], 1.0, 1e-6);

    // Where the spheres are: in every frame the exported ones, moved rigidly. Tolerance 1 nm: 15 digits are dumped, rotations are renormalised every step.
    const std::vector<Frame> frames = frames_of(folder.read("run.dump"));
    ASSERT_EQ(frames.size(), 2U);
    for (const Frame& frame : frames) {
        ASSERT_EQ(frame.centres.size(), clump.rigid.spheres.size());
        for (std::size_t i = 0; i < frame.radii.size(); ++i) EXPECT_NEAR(frame.radii[i], clump.rigid.spheres[i].radius, 1e-15);
        EXPECT_LT(fit_pose(clump.rigid.spheres, frame.centres).worst, 1e-9);
    }

    // Energies right after insertion: translation ½ m v² to all digits; rotation with the spin given in the world.
    const std::vector<double> energy = numbers_after(log, "\n       1       24 ");
    ASSERT_EQ(energy.size(), 2U) << log;
    EXPECT_NEAR(energy[0] / (0.5 * mass.mass * Vec3(0.1, 0.05, -0.02).squaredNorm()), 1.0, 1e-12);
    const Quat start(0.8, 0.0, 0.6, 0.0);
    const Vec3 spin(60.0, -40.0, 90.0);
    EXPECT_NEAR(energy[1] / spin_energy(start, spin, mass.principal_inertia), 1.0, 1e-6);  // Richardson iteration, 1 µs into the flight

    // The turn between 25 and 50 ms, 2.8 rad about an axis that is no principal one: depends on the ratios of the moments. The frame times are counted from
    // the first step; LIGGGHTS' integrator is second order with a 1 µs step, so 1e-4 rad is generous; a moment wrong by 1 % gives 1e-2 rad.
    for (const Frame& frame : frames) {
        const double time = static_cast<double>(frame.step) * 1e-6;
        const Quat expected = free_rotation(start, spin, mass.principal_inertia, time);
        EXPECT_LT(fit_pose(clump.rigid.spheres, frame.centres).pose.orientation.angularDistance(expected), 1e-3) << frame.step;
    }
    MassProperties wrong = mass;
    wrong.principal_inertia[0] *= 1.02;
    EXPECT_GT(fit_pose(clump.rigid.spheres, frames[1].centres).pose.orientation.angularDistance(free_rotation(start, spin, wrong.principal_inertia, 0.05)),
              3e-3)
        << "the test would not see a wrong moment";
    const Vec3 travelled = fit_pose(clump.rigid.spheres, frames[1].centres).pose.position - fit_pose(clump.rigid.spheres, frames[0].centres).pose.position;
    const double between = static_cast<double>(frames[1].step - frames[0].step) * 1e-6;
    EXPECT_LT((travelled / between - Vec3(0.1, 0.05, -0.02)).norm(), 1e-8);  // the centre of mass flies straight
}

}  // namespace
}  // namespace pelletlab::crosscode
