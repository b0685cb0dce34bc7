// Repairs on demand: each kind of broken mesh becomes a closed body of the volume that one expects, and the report says how.
#include "meshes/repair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes/makers.hpp"
#include "meshes/signed_distance.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

using test::joined;
using test::moved;

TriangleMesh cube() {
    return make_box({0, 0, 0}, {2e-3, 2e-3, 2e-3});
}

/// A cylinder without its lower end.
TriangleMesh open_cylinder() {
    TriangleMesh mesh = make_cylinder(3e-3, 3e-3, 32, true);
    std::erase_if(mesh.faces, [&](const Triangle& t) {
        return mesh.vertices[t[0]].z() < -1.499e-3 && mesh.vertices[t[1]].z() < -1.499e-3 && mesh.vertices[t[2]].z() < -1.499e-3;
    });
    return mesh;
}

bool says(const CheckedMesh& checked, const std::string& part) {
    for (const std::string& line : checked.report.repairs)
        if (line.find(part) != std::string::npos) return true;
    return false;
}

TEST(Repair, LeavesGoodMeshesAlone) {
    const CheckedMesh checked = repair_to_closed_body(cube());
    EXPECT_EQ(checked.mesh.faces, cube().faces);
    EXPECT_TRUE(checked.report.repairs.empty());
}

TEST(Repair, OpenEndIsClosedFlat) {
    const CheckedMesh checked = repair_to_closed_body(open_cylinder());
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_EQ(checked.before.boundary_edges, 32U);
    EXPECT_NEAR(checked.report.volume / (std::numbers::pi / 4 * 27e-9), 1.0, 1e-9);
    EXPECT_TRUE(says(checked, "1 hole closed")) << checked.report.summary();
    EXPECT_TRUE(says(checked, "9.4")) << "the rim's length of pi D = 9.4 mm";
}

TEST(Repair, SeveralHolesAndMixedOrientation) {
    TriangleMesh mesh = make_sphere(2e-3, 3);
    const double volume = check(mesh).volume;
    for (std::size_t f = 0; f < mesh.faces.size(); f += 9) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
    mesh.faces.erase(mesh.faces.begin() + 700);
    mesh.faces.erase(mesh.faces.begin() + 10, mesh.faces.begin() + 14);
    const CheckedMesh checked = repair_to_closed_body(mesh);
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_NEAR(checked.report.volume / volume, 1.0, 2e-3);  // flat patches over 5 of 1280 facets
    EXPECT_TRUE(says(checked, "holes closed with a patch"));
    EXPECT_TRUE(says(checked, "turned to agree"));
}

TEST(Repair, CrossingShellsAreUnited) {
    // Two cubes of 8 mm³ that share 1 × 0.9 × 0.8 mm³.
    const CheckedMesh boxes = repair_to_closed_body(joined(cube(), moved(cube(), {1e-3, 1.1e-3, 1.2e-3})));
    EXPECT_NEAR(boxes.report.volume / 15.28e-9, 1.0, 1e-12);
    EXPECT_TRUE(says(boxes, "2 shells united"));
    // Also where one of them is inside-out.
    const CheckedMesh turned = repair_to_closed_body(joined(cube(), test::flipped(moved(cube(), {1e-3, 1.1e-3, 1.2e-3}))));
    EXPECT_NEAR(turned.report.volume / 15.28e-9, 1.0, 1e-12);
    // Two spheres of radius r, centres d apart: their lens is π (2r − d)² (d² + 4rd) / (12 d).
    const double r = 1e-3, d = 1e-3, pi = std::numbers::pi;
    const CheckedMesh spheres = repair_to_closed_body(joined(make_sphere(2 * r, 4), moved(make_sphere(2 * r, 4), {d, 0.01e-3, 0.02e-3})));
    const double lens = pi * (2 * r - d) * (2 * r - d) * (d * d + 4 * r * d) / (12 * d);
    EXPECT_NEAR(spheres.report.volume / (8.0 / 3.0 * pi * r * r * r - lens), 1.0, 3e-3);  // inscribed facets: 1.2e-3 short
}

TEST(Repair, SelfCrossingShellIsWrapped) {
    TriangleMesh dented = make_sphere(2e-3, 3);
    const double volume = check(dented).volume;
    dented.vertices[0] *= -1.5;  // one corner pulled through the far side
    const CheckedMesh checked = repair_to_closed_body(dented);
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_TRUE(says(checked, "wrapped"));
    EXPECT_NEAR(checked.report.volume / volume, 1.0, 0.05);
}

TEST(Repair, BodiesThatTouchAreWrappedIntoOne) {
    const CheckedMesh checked = repair_to_closed_body(joined(cube(), moved(cube(), {2e-3, 2e-3, 0})));  // along an edge
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_NEAR(checked.report.volume / 16e-9, 1.0, 0.02);
}

TEST(Repair, WrapStaysCloseToTheSurface) {
    const TriangleMesh mesh = make_cylinder(3e-3, 3e-3, 32, true);
    const CheckedMesh checked = repair_to_closed_body(mesh, {RepairMethod::alpha_wrap, 0.2e-3, 0.005e-3});
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_TRUE(says(checked, "alpha 200 um and offset 5 um")) << checked.report.summary();
    const auto given = exact_signed_distance(mesh);
    for (const Vec3& v : checked.mesh.vertices) ASSERT_LE(std::abs(given->value(v)), 0.0101e-3);
    EXPECT_NEAR(checked.report.volume / check(mesh).volume, 1.0, 5e-3);
}

TEST(Repair, WrapOfAnOpenSurfaceFindsAnAlphaThatDoesNotSlipIn) {
    const CheckedMesh checked = repair_to_closed_body(open_cylinder(), {RepairMethod::alpha_wrap});
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_NEAR(checked.report.volume / (std::numbers::pi / 4 * 27e-9), 1.0, 0.35);  // the mouth is bridged by a sphere of a third of its width or more
    // A given alpha is kept, and what it cannot do is said.
    EXPECT_NE(test::refusal([] { repair_to_closed_body(open_cylinder(), {RepairMethod::alpha_wrap, 0.2e-3}); }).find("too open"), std::string::npos);
}

TEST(Repair, RefusesWhatIsNoBody) {
    TriangleMesh sheet = make_disc(1e-3, 0.0, true, 16);
    test::refusal([&] { repair_to_closed_body(sheet); });
    for (Vec3& v : sheet.vertices) v = Quat(Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized())) * v;
    test::refusal([&] { repair_to_closed_body(sheet); });
    test::refusal([&] { repair_to_closed_body(sheet, {RepairMethod::alpha_wrap}); });
    EXPECT_NE(test::refusal([] { repair_to_closed_body(joined(cube(), moved(cube(), {50e-3, 0, 0}))); }).find("separate bodies"), std::string::npos);
    test::refusal([] { repair_to_closed_body({}); });
    TriangleMesh huge = open_cylinder();
    for (Vec3& v : huge.vertices) v *= 1e6;
    EXPECT_NE(test::refusal([&] { repair_to_closed_body(huge); }).find("unit"), std::string::npos);
    test::refusal([] { repair_to_closed_body(open_cylinder(), {RepairMethod::unite_shells}); });
    test::refusal([] { repair_to_closed_body(cube(), {RepairMethod::alpha_wrap, -1.0}); });
    test::refusal([] { repair_to_closed_body(cube(), {RepairMethod::alpha_wrap, 1e-7}); });
    EXPECT_NE(test::refusal([] {
                  repair_to_closed_body(joined(cube(), moved(cube(), {1e-3, 1e-3, 1e-3})), {RepairMethod::fill_holes});
              }).find("crosses"),
              std::string::npos);
}

}  // namespace
}  // namespace pelletlab::meshes
