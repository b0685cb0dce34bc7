#include "solver/detail/wall_mesh.hpp"

#include <gtest/gtest.h>

#include "../../verification/solver/scene.hpp"
#include "core/error.hpp"
#include "solver/detail/wall_query.hpp"

namespace pelletlab::solver::detail {
namespace {

constexpr double thirty_degrees = M_PI / 6.0;

TEST(WallMesh, ABoxHasSixPatchesAndNoBorder) {
    const WallMesh wall = make_wall_mesh(scene::box(Vec3::Zero(), Vec3::Ones()), thirty_degrees, "box");
    EXPECT_EQ(wall.report.faces, 12u);
    EXPECT_EQ(wall.report.patches, 6u);
    EXPECT_EQ(wall.report.border_edges, 0u);
    EXPECT_EQ(wall.report.crowded_edges, 0u);
}

TEST(WallMesh, ATubeIsOnePatchOnceItsFacetsAreFlatEnough) {
    EXPECT_EQ(inspect_wall(scene::tube(1.0, 1.0, 8)).patches, 8u);   // joins of 45°
    EXPECT_EQ(inspect_wall(scene::tube(1.0, 1.0, 24)).patches, 1u);  // joins of 15°
    EXPECT_EQ(inspect_wall(scene::tube(1.0, 1.0, 24)).border_edges, 48u);
}

TEST(WallMesh, TriangleSoupIsWelded) {
    const TriangleMesh box = scene::box(Vec3::Zero(), Vec3::Ones());
    TriangleMesh soup;
    for (const Triangle& f : box.faces) {
        const auto n = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t v : f) soup.vertices.push_back(box.vertices[v]);
        soup.faces.push_back({n, n + 1, n + 2});
    }
    const WallMesh wall = make_wall_mesh(soup, thirty_degrees, "soup");
    EXPECT_EQ(wall.vertices.size(), 8u);
    EXPECT_EQ(wall.report.border_edges, 0u);
}

TEST(WallMesh, FaultsAreCounted) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.5, -1, 0}, {0, -1, 0}, {2, 0, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}, {3, 2, 0}, {0, 1, 7}, {0, 4, 6}, {4, 6, 5}};  // a double face, one without area, a T-junction at (0.5, 0)
    const WallReport report = inspect_wall(mesh);
    EXPECT_EQ(report.double_faces, 1u);
    EXPECT_EQ(report.degenerate_faces, 1u);
    EXPECT_EQ(report.faces, 4u);
    EXPECT_EQ(report.t_junctions, 1u);
    EXPECT_EQ(report.turned_joins, 1u);
}

TEST(WallMesh, EmptyAndBrokenMeshesAreRefused) {
    TriangleMesh nothing;
    EXPECT_THROW(make_wall_mesh(nothing, 0.5, "w"), Error);
    TriangleMesh bad = scene::plate(1.0);
    bad.vertices[0].x() = std::nan("");
    EXPECT_THROW(make_wall_mesh(bad, 0.5, "w"), Error);
    TriangleMesh index = scene::plate(1.0);
    index.faces[0][1] = 99;
    EXPECT_THROW(make_wall_mesh(index, 0.5, "w"), Error);
    TriangleMesh flat;
    flat.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.faces = {{0, 1, 2}};
    EXPECT_THROW(make_wall_mesh(flat, 0.5, "w"), Error);
}

TEST(ClosestPoint, AgreesWithDenseSampling) {
    TriangleMesh mesh;
    mesh.vertices = {{0.1, 0.2, 0.3}, {1.3, -0.2, 0.1}, {0.4, 0.9, -0.5}};
    mesh.faces = {{0, 1, 2}};
    const WallMesh wall = make_wall_mesh(mesh, 0.5, "t");
    RandomStream random(1, 0);
    for (int k = 0; k < 300; ++k) {
        const Vec3 p(random.uniform(-1, 2), random.uniform(-1, 2), random.uniform(-1, 1));
        const Hit hit = closest_point(wall, 0, p);
        double best = 1e9;
        constexpr int n = 60;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; i + j <= n; ++j) {
                const Vec3 q = mesh.vertices[0] + (mesh.vertices[1] - mesh.vertices[0]) * (1.0 * i / n) + (mesh.vertices[2] - mesh.vertices[0]) * (1.0 * j / n);
                best = std::min(best, (q - p).norm());
            }
        EXPECT_LE(std::sqrt(hit.distance2), best + 1e-12);
        EXPECT_GT(std::sqrt(hit.distance2), best - 0.03);  // the sampling is 1/60 of the triangle's size apart
        EXPECT_NEAR((hit.point - p).squaredNorm(), hit.distance2, 1e-14);
    }
}

TEST(WallQuery, FindsExactlyTheFacesOfBruteForce) {
    const WallMesh wall = make_wall_mesh(scene::tube(0.05, 0.04, 180), thirty_degrees, "tube");
    const WallQuery query(wall);
    std::vector<std::uint32_t> found;
    for (int k = 0; k < 400; ++k) {
        RandomStream random(5, static_cast<std::uint64_t>(k));
        const Vec3 p(random.uniform(-0.06, 0.06), random.uniform(-0.03, 0.03), random.uniform(-0.06, 0.06));
        const double radius = random.uniform(0.0, 0.01);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t f = 0; f < wall.faces.size(); ++f)
            if (closest_point(wall, f, p).distance2 <= radius * radius) expected.push_back(f);
        query.faces_near(wall, p, radius, found);
        EXPECT_EQ(found, expected);
    }
}

std::vector<Hit> contacts_of(const WallMesh& wall, const Vec3& centre, double radius) {
    std::vector<Hit> hits;
    for (std::uint32_t f = 0; f < wall.faces.size(); ++f) {
        const Hit hit = closest_point(wall, f, centre);
        if (hit.distance2 < radius * radius) hits.push_back(hit);
    }
    keep_contacts(wall, centre, radius, hits);
    return hits;
}

TriangleMesh folded(double bend) {  // two long rectangles that meet along the y axis; positive bend: a valley seen from +z
    TriangleMesh mesh;
    const Vec3 left(-std::cos(0.5 * bend), 0, std::sin(0.5 * bend)), right(std::cos(0.5 * bend), 0, std::sin(0.5 * bend));
    for (const double y : {-1.0, 1.0})
        for (const Vec3& side : {left, Vec3(Vec3::Zero()), right}) mesh.vertices.push_back(side + Vec3(0, y, 0));
    mesh.faces = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    return mesh;
}

TEST(KeepContacts, AValleyGivesTwoContactsOnlyWhereBothFacesAreTouched) {
    for (const double bend : {M_PI / 2.0, M_PI / 3.0}) {
        const WallMesh wall = make_wall_mesh(folded(bend), thirty_degrees, "valley");
        const double r = 0.1, height = (r - 1e-3) / std::cos(0.5 * bend);
        EXPECT_EQ(contacts_of(wall, {0, 0, height}, r).size(), 2u);
        // Along one face, away from the valley: one contact, although the other face's edge is within reach.
        const Vec3 along(std::cos(0.5 * bend), 0, std::sin(0.5 * bend)), normal(-std::sin(0.5 * bend), 0, std::cos(0.5 * bend));
        for (const double s : {0.2, 0.12}) EXPECT_EQ(contacts_of(wall, along * s + normal * (r - 1e-3), r).size(), 1u) << bend << " " << s;
    }
}

TEST(KeepContacts, AFlatValleyBelowTheFeatureAngleGivesOne) {
    const WallMesh wall = make_wall_mesh(folded(M_PI / 18.0), thirty_degrees, "valley");
    EXPECT_EQ(contacts_of(wall, {0, 0, 0.0999}, 0.1).size(), 1u);
}

TEST(KeepContacts, ARidgeGivesOneContactOnFaceEdgeAndFace) {
    for (const double bend : {-M_PI / 2.0, -M_PI / 18.0, -0.9 * M_PI}) {
        const WallMesh wall = make_wall_mesh(folded(bend), thirty_degrees, "ridge");
        for (int k = -40; k <= 40; ++k) {
            const double a = k / 40.0 * (0.5 * M_PI);
            const Vec3 centre = Vec3(std::sin(a), 0, std::cos(a)) * 0.0999;
            const auto hits = contacts_of(wall, centre, 0.1);
            EXPECT_EQ(hits.size(), 1u) << bend << " " << a;
        }
    }
}

TEST(KeepContacts, AVertexOfABoxGivesOneContactFromOutside) {
    const WallMesh wall = make_wall_mesh(scene::box(-Vec3::Ones(), Vec3::Zero()), thirty_degrees, "box");
    EXPECT_EQ(contacts_of(wall, Vec3(1, 1, 1).normalized() * 0.099, 0.1).size(), 1u);
    EXPECT_EQ(contacts_of(wall, Vec3(1, 0.001, 0.0).normalized() * 0.099 + Vec3(0, 0, -0.3), 0.1).size(), 1u);
}

TEST(KeepContacts, ATJunctionDoesNotPushTwice) {
    // Left one large triangle pair, right two small ones whose common vertex lies inside the left edge.
    TriangleMesh mesh;
    mesh.vertices = {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}, {0, 0.1, 0}, {1, -1, 0}, {1, 1, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}, {1, 5, 4}, {4, 5, 6}, {4, 6, 2}};
    const WallMesh wall = make_wall_mesh(mesh, thirty_degrees, "t");
    EXPECT_GT(wall.report.t_junctions, 0u);
    for (int k = -20; k <= 20; ++k) EXPECT_EQ(contacts_of(wall, {k * 0.004, 0.05, 0.099}, 0.1).size(), 1u) << k;
}

}  // namespace
}  // namespace pelletlab::solver::detail
