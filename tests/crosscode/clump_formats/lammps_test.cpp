// LAMMPS reads the molecule file and deposits one body: the mass and inertia it reports are ours, also after a second run (the trap that «reinit no» avoids),
// and a push on one sphere turns the body as our inertia says (the trap of moments below 1e-6, issue 1657).
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "free_flight.hpp"
#include "program.hpp"

namespace pelletlab::crosscode {
namespace {

constexpr int pushed = 4;  // sphere that gets the force; LAMMPS counts from 1
constexpr int steps = 100;

/// Input in the units of the export; `size` is about the diameter of the pellet in them.
std::string input(const std::string& units, double size, double force) {
    std::ostringstream text;
    text << "units " << units << "\natom_style hybrid sphere molecular\nboundary f f f\ncomm_modify vel yes\nnewton off\n";
    text << "region box block " << -5 * size << ' ' << 5 * size << ' ' << -5 * size << ' ' << 5 * size << ' ' << -5 * size << ' ' << 5 * size
         << "\ncreate_box 1 box\n";
    text << "pair_style zero " << size << "\npair_coeff * *\ninclude unlike.lammps.in\n";
    text << "region ins block " << -0.3 * size << ' ' << 0.3 * size << ' ' << -0.3 * size << ' ' << 0.3 * size << ' ' << -0.3 * size << ' ' << 0.3 * size
         << "\n";
    text << "fix put all deposit 1 0 1 12345 region ins mol unlike rigid rigid_unlike orient 0.3 0.5 1 vz 0 0\n";
    text << "timestep 1e-6\nthermo_style custom step atoms\nthermo_modify lost error\nrun 2\nunfix put\ngroup one id " << pushed + 1
         << "\nfix push one addforce " << force << " 0 0\n";
    text << "compute body all rigid/local rigid_unlike mass inertiax inertiay inertiaz omegax omegay omegaz x y z vx\n";
    text << "dump b all local " << steps
         << " body.txt c_body[*]\ndump_modify b format line \"%.15g %.15g %.15g %.15g %.15g %.15g %.15g %.15g %.15g %.15g %.15g\"\n";
    text << "dump a all custom " << steps << " atoms.txt id x y z radius\ndump_modify a sort id format line \"%d %.15g %.15g %.15g %.15g\"\nrun " << steps
         << "\n";
    return text.str();
}

/// Rows of numbers below the last «ITEM: » line of a dump.
std::vector<std::vector<double>> last_rows(const std::string& dump) {
    std::vector<std::vector<double>> rows;
    std::istringstream lines(dump);
    std::string line;
    while (std::getline(lines, line)) {
        if (line.rfind("ITEM:", 0) == 0) {
            rows.clear();
            continue;
        }
        std::istringstream words(line);
        rows.emplace_back();
        double value = 0.0;
        while (words >> value) rows.back().push_back(value);
    }
    return rows;
}

void expect_our_body(const std::string& units, double metre, double kilogram) {
    std::string program = find_program("lmp");
    if (program.empty()) program = find_program("lammps");
    if (program.empty()) GTEST_SKIP() << "lammps is not installed (Debian package lammps)";
    const Folder folder;
    const ClumpTemplate clump = unlike_pellet();
    const MassProperties& mass = clump.rigid.mass_properties;
    shapegen::formats::WriteOptions options;
    options.length_unit = metre == 1.0 ? "m" : "cm";
    options.mass_unit = kilogram == 1.0 ? "kg" : "g";
    folder.write(shapegen::formats::find("lammps").write(clump, options));
    const double force = 1e-4;  // [N]
    folder.write("in.run", input(units, 0.004 / metre, force / (kilogram * metre)));
    ASSERT_EQ(folder.run(program + " -in in.run"), 0) << folder.read("output.txt");

    const std::vector<std::vector<double>> bodies = last_rows(folder.read("body.txt")), atoms = last_rows(folder.read("atoms.txt"));
    ASSERT_EQ(bodies.size(), 1U);
    ASSERT_EQ(bodies[0].size(), 11U);
    const std::vector<double>& body = bodies[0];
    EXPECT_NEAR(body[0] * kilogram / mass.mass, 1.0, 1e-12);
    std::vector<double> inertia(body.begin() + 1, body.begin() + 4);
    std::sort(inertia.begin(), inertia.end());
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(inertia[static_cast<std::size_t>(k)] * kilogram * metre * metre / mass.principal_inertia[k], 1.0, 1e-12);

    ASSERT_EQ(atoms.size(), clump.rigid.spheres.size());
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        ASSERT_EQ(atoms[i].size(), 5U);
        positions.push_back(Vec3(atoms[i][1], atoms[i][2], atoms[i][3]) * metre);
        EXPECT_NEAR(atoms[i][4] * metre, clump.rigid.spheres[i].radius, 1e-15);
    }
    const FittedPose fitted = fit_pose(clump.rigid.spheres, positions);
    EXPECT_LT(fitted.worst, 1e-12);
    EXPECT_LT((fitted.pose.position - Vec3(body[7], body[8], body[9]) * metre).norm(), 1e-12);  // centre of mass

    // Spin after 0.1 ms of a constant force, I⁻¹ τ t, the body turns by 1e-6 rad meanwhile. The clock is the speed of the centre, m v / F: whether the force
    // acts in the first half step depends on the order of the fixes.
    const double time = mass.mass * body[10] * metre / force;
    EXPECT_NEAR(time, steps * 1e-6, 4e-6);
    const Vec3 arm = positions[pushed] - fitted.pose.position;
    const Vec3 torque_body = fitted.pose.orientation.conjugate() * arm.cross(Vec3(force, 0.0, 0.0));
    const Vec3 spin = fitted.pose.orientation * Vec3(torque_body.cwiseQuotient(mass.principal_inertia) * time);
    EXPECT_GT(spin.norm(), 0.005);
    EXPECT_LT((Vec3(body[4], body[5], body[6]) - spin).norm(), 1e-5 * spin.norm());
}

TEST(Lammps, TurnsThePelletInSiUnits) {
    expect_our_body("si", 1.0, 1.0);
}
TEST(Lammps, TurnsThePelletInCgsUnits) {
    expect_our_body("cgs", 1e-2, 1e-3);
}

}  // namespace
}  // namespace pelletlab::crosscode
