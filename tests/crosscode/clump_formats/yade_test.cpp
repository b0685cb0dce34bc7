// Yade builds the pellet with the exported function and lets it fly.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "free_flight.hpp"
#include "program.hpp"

namespace pelletlab::crosscode {
namespace {

constexpr const char* script = R"(
exec(open('unlike_yade.py').read())
import json, os
material = O.materials.append(FrictMat(young=5e6, poisson=0.25, density=1800))
material = O.materials[material]
clump, ids = append_pellet(material, (0.01, -0.02, 0.03), Quaternion(0.8, 0.0, 0.6, 0.0))
body = O.bodies[clump]
state = body.state
orientation = Quaternion(0.8, 0.0, 0.6, 0.0)
spin = Vector3(60, -40, 90)
state.vel = Vector3(0.1, 0.05, -0.02)
state.angVel = spin
i = Vector3(*INERTIA)
local = orientation.conjugate() * spin
state.angMom = orientation * Vector3(i[0] * local[0], i[1] * local[1], i[2] * local[2])
frames = []
def frame():
    frames.append([list(O.bodies[k].state.pos) for k in ids])
frame()
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
             NewtonIntegrator(damping=0, gravity=(0, 0, 0))]
O.dt = 2e-6
O.run(25000, True)
frame()
from yade import ymport
text = len(ymport.textExt('unlike.yade.txt'))
json.dump(dict(mass=state.mass, inertia=list(state.inertia), frames=frames, radii=[O.bodies[k].shape.radius for k in ids],
               member_mass=[O.bodies[k].state.mass for k in ids], bodies=len([b for b in O.bodies if b is not None]), text=text,
               aspherical=body.aspherical), open('result.json', 'w'))
os._exit(0)
)";

TEST(Yade, FliesThePelletWeExported) {
    const std::string program = find_program("yade");
    if (program.empty()) GTEST_SKIP() << "yade is not installed (Debian package yade)";
    const Folder folder;
    const ClumpTemplate clump = unlike_pellet();
    const MassProperties& mass = clump.rigid.mass_properties;
    folder.write(shapegen::formats::find("yade").write(clump, {}));
    folder.write("run.py", script);
    ASSERT_EQ(folder.run(program + " -n -x -j1 run.py"), 0) << folder.read("output.txt");
    const std::string text = folder.read("result.json");
    ASSERT_FALSE(text.empty()) << folder.read("output.txt");
    const nlohmann::json result = nlohmann::json::parse(text);

    EXPECT_NEAR(result["mass"].get<double>() / mass.mass, 1.0, 1e-12);
    std::vector<double> inertia = result["inertia"].get<std::vector<double>>();  // Yade sorts them; ours ascend already
    ASSERT_EQ(inertia.size(), 3U);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(inertia[static_cast<std::size_t>(k)] / mass.principal_inertia[k], 1.0, 1e-12);
    EXPECT_TRUE(result["aspherical"].get<bool>());
    EXPECT_EQ(result["bodies"].get<std::size_t>(), clump.rigid.spheres.size() + 1);  // spheres and the clump: the carrier is gone
    EXPECT_EQ(result["text"].get<std::size_t>(), clump.rigid.spheres.size());        // ymport.textExt reads the text file
    for (const double member : result["member_mass"].get<std::vector<double>>()) EXPECT_NEAR(member / mass.mass, 1.0, 1e-12);
    const std::vector<double> radii = result["radii"].get<std::vector<double>>();
    for (std::size_t i = 0; i < radii.size(); ++i) EXPECT_EQ(radii[i], clump.rigid.spheres[i].radius);

    std::vector<FittedPose> poses;
    for (const auto& frame : result["frames"]) {
        std::vector<Vec3> positions;
        for (const auto& p : frame) positions.emplace_back(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
        ASSERT_EQ(positions.size(), clump.rigid.spheres.size());
        poses.push_back(fit_pose(clump.rigid.spheres, positions));
        EXPECT_LT(poses.back().worst, 1e-9);  // the exported spheres, moved rigidly
    }
    const Quat start(0.8, 0.0, 0.6, 0.0);
    const Vec3 spin(60.0, -40.0, 90.0);
    EXPECT_LT(poses[0].pose.orientation.angularDistance(start), 1e-9);
    EXPECT_LT((poses[0].pose.position - Vec3(0.01, -0.02, 0.03)).norm(), 1e-12);
    EXPECT_LT((poses[1].pose.position - poses[0].pose.position - 0.05 * Vec3(0.1, 0.05, -0.02)).norm(), 1e-9);
    // Leapfrog with 2 µs steps over 5.8 rad; a moment wrong by 2 % shows as more than 3e-3 rad.
    EXPECT_LT(poses[1].pose.orientation.angularDistance(free_rotation(start, spin, mass.principal_inertia, 0.05)), 1e-3);
    EXPECT_GT(poses[1].pose.orientation.angularDistance(free_rotation(start, spin, mass.principal_inertia.cwiseProduct(Vec3(1.02, 1.0, 1.0)), 0.05)), 3e-3)
        << "the test would not see a wrong moment";
}

TEST(Yade, TakesASingleOffCentreSphere) {
    const std::string program = find_program("yade");
    if (program.empty()) GTEST_SKIP() << "yade is not installed (Debian package yade)";
    const Folder folder;
    ClumpTemplate clump = unlike_pellet();
    clump.rigid.spheres = {{Vec3(0.0002, 0.0, -0.0001), 0.001}};
    folder.write(shapegen::formats::find("yade").write(clump, {}));
    folder.write("run.py",
                 "exec(open('unlike_yade.py').read())\nc, ids = append_pellet(FrictMat(), (1, 2, 3))\nprint('ANSWER', *O.bodies[c].state.pos, "
                 "*O.bodies[ids[0]].state.pos, O.bodies[c].state.mass)\nimport sys, os\nsys.stdout.flush()\nos._exit(0)\n");
    ASSERT_EQ(folder.run(program + " -n -x -j1 run.py"), 0) << folder.read("output.txt");
    const std::vector<double> answer = numbers_after(folder.read("output.txt"), "ANSWER ");
    ASSERT_EQ(answer.size(), 7U) << folder.read("output.txt");
    EXPECT_NEAR(answer[0], 1.0, 1e-12);
    EXPECT_NEAR(answer[3], 1.0002, 1e-12);
    EXPECT_NEAR(answer[5], 2.9999, 1e-12);
    EXPECT_NEAR(answer[6] / clump.rigid.mass_properties.mass, 1.0, 1e-12);
}

}  // namespace
}  // namespace pelletlab::crosscode
