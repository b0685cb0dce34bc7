// Each defect is found, counted and placed; what has one right answer is repaired and said; the rest is refused in words.
#include "meshes/check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "meshes/makers.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

TriangleMesh cube() {
    return make_box({0, 0, 0}, {2e-3, 2e-3, 2e-3});
}

bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

std::string refusal_of(const TriangleMesh& mesh) {
    return test::refusal([&] { require_closed_body(mesh); });
}

TEST(Check, GoodBodyIsGood) {
    const CheckedMesh checked = require_closed_body(cube());
    EXPECT_TRUE(checked.before.is_closed_body());
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_TRUE(checked.report.repairs.empty());
    EXPECT_EQ(checked.report.shells, 1U);
    EXPECT_EQ(checked.report.separate_bodies, 1U);
    EXPECT_NEAR(checked.report.volume, 8e-9, 1e-22);
    EXPECT_TRUE(mentions(checked.report.summary(), "closed"));
    EXPECT_TRUE(mentions(checked.report.summary(), "volume 8 mm^3"));
}

TEST(Check, OpenSurfaceIsRefusedWithCountAndPlace) {
    TriangleMesh open = cube();
    open.faces.pop_back();  // half of the side x = 2 mm
    EXPECT_EQ(check(open).boundary_edges, 3U);
    EXPECT_FALSE(check(open).is_closed_body());
    const std::string words = refusal_of(open);
    EXPECT_TRUE(mentions(words, "not closed: 3 edges")) << words;
    EXPECT_TRUE(mentions(words, "near (2, ")) << words;
}

TEST(Check, InsideOutIsRepairedAndSaid) {
    const CheckedMesh checked = require_closed_body(test::flipped(cube()));
    EXPECT_TRUE(checked.before.inside_out);
    EXPECT_FALSE(checked.before.is_closed_body());
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_NEAR(checked.report.volume, 8e-9, 1e-22);
    ASSERT_EQ(checked.report.repairs.size(), 1U);
    EXPECT_TRUE(mentions(checked.report.repairs[0], "inside-out"));
}

TEST(Check, MixedOrientationIsRepairedAndSaid) {
    TriangleMesh mixed = make_sphere(2e-3, 2);
    for (std::size_t f = 0; f < mixed.faces.size(); f += 7) std::swap(mixed.faces[f][0], mixed.faces[f][1]);
    EXPECT_GT(check(mixed).inconsistent_edges, 0U);
    const CheckedMesh checked = require_closed_body(mixed);
    EXPECT_TRUE(checked.report.is_closed_body());
    ASSERT_EQ(checked.report.repairs.size(), 1U);
    EXPECT_TRUE(mentions(checked.report.repairs[0], "46 triangles turned")) << checked.report.repairs[0];
}

TEST(Check, MostlyTurnedSurfaceEndsOutward) {
    TriangleMesh mixed = make_sphere(2e-3, 2);
    for (std::size_t f = 0; f < mixed.faces.size(); ++f)
        if (f % 5 != 0) std::swap(mixed.faces[f][0], mixed.faces[f][1]);
    EXPECT_GT(require_closed_body(mixed).report.volume, 0.0);
}

TEST(Check, DuplicateAndUnweldedTrianglesAreRepaired) {
    TriangleMesh mesh = cube();
    mesh.faces.push_back(mesh.faces[0]);
    mesh.faces.push_back({mesh.faces[1][0], mesh.faces[1][2], mesh.faces[1][1]});
    EXPECT_EQ(check(mesh).duplicate_faces, 2U);
    CheckedMesh checked = require_closed_body(mesh);
    EXPECT_EQ(checked.mesh.faces.size(), 12U);
    EXPECT_TRUE(mentions(checked.report.repairs.at(0), "2 duplicate triangles"));

    TriangleMesh soup;  // each triangle with its own corners, as STL stores them
    for (const Triangle& t : cube().faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t v : t) soup.vertices.push_back(cube().vertices[v]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    checked = require_closed_body(soup);
    EXPECT_EQ(checked.mesh.vertices.size(), 8U);
    EXPECT_TRUE(mentions(checked.report.repairs.at(0), "28 vertices joined"));
}

TEST(Check, TrianglesWithoutAreaAreRemovedAndTheSurfaceStaysClosed) {
    // A cap: a vertex in the middle of the edge between two sides, joined to one side only through a flat triangle.
    TriangleMesh cap = cube();
    const auto [a, b, c] = cap.faces[0];
    const auto m = static_cast<std::uint32_t>(cap.vertices.size());
    cap.vertices.push_back(0.5 * (cap.vertices[a] + cap.vertices[b]));
    cap.faces[0] = {a, m, c};
    cap.faces.push_back({m, b, c});
    cap.faces.push_back({a, b, m});
    EXPECT_EQ(check(cap).degenerate_faces, 1U);
    EXPECT_EQ(check(cap).boundary_edges, 0U);
    CheckedMesh checked = require_closed_body(cap);
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_EQ(checked.mesh.faces.size(), 14U);
    EXPECT_NEAR(checked.report.volume, 8e-9, 1e-22);
    EXPECT_TRUE(mentions(checked.report.repairs.at(0), "1 triangle without area removed"));

    // A needle: the edge a–b split by two points that almost coincide.
    TriangleMesh needle = cube();
    const auto p = static_cast<std::uint32_t>(needle.vertices.size()), q = p + 1;
    std::uint32_t other = 0;  // the triangle across a → b
    for (std::uint32_t f = 1; f < needle.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            if (needle.faces[f][k] == b && needle.faces[f][(k + 1) % 3] == a) other = f;
    const std::uint32_t d = needle.faces[other][0] + needle.faces[other][1] + needle.faces[other][2] - a - b;
    needle.vertices.push_back(0.5 * (needle.vertices[a] + needle.vertices[b]));
    needle.vertices.push_back(needle.vertices[p] + 1e-14 * (needle.vertices[b] - needle.vertices[a]).normalized());
    needle.faces[0] = {a, p, c};
    needle.faces.push_back({p, q, c});
    needle.faces.push_back({q, b, c});
    needle.faces[other] = {b, q, d};
    needle.faces.push_back({q, p, d});
    needle.faces.push_back({p, a, d});
    EXPECT_EQ(check(needle).degenerate_faces, 2U);
    checked = require_closed_body(needle);
    EXPECT_TRUE(checked.report.is_closed_body()) << checked.report.summary();
    EXPECT_EQ(checked.report.degenerate_faces, 0U);
    EXPECT_NEAR(checked.report.volume, 8e-9, 1e-18);
}

TEST(Check, RepeatedCornersAreRemoved) {
    TriangleMesh mesh = cube();
    mesh.faces.push_back({1, 1, 3});
    EXPECT_EQ(check(mesh).degenerate_faces, 1U);
    EXPECT_EQ(require_closed_body(mesh).mesh.faces.size(), 12U);
}

TEST(Check, SelfIntersectionIsRefusedWithCountAndPlace) {
    const TriangleMesh crossing = test::joined(cube(), test::moved(cube(), {1e-3, 1.1e-3, 1.2e-3}));
    EXPECT_GT(check(crossing).self_intersections, 0U);
    const std::string words = refusal_of(crossing);
    EXPECT_TRUE(mentions(words, "crosses itself")) << words;
    EXPECT_TRUE(mentions(words, "pairs of triangles")) << words;

    TriangleMesh dented = make_sphere(2e-3, 2);  // one vertex pulled through the far side
    dented.vertices[0] *= -1.5;
    EXPECT_GT(check(dented).self_intersections, 0U);
}

TEST(Check, NeighboursThatOnlyTouchDoNotCross) {
    EXPECT_EQ(check(make_sphere(3e-3, 3)).self_intersections, 0U);
    EXPECT_EQ(check(make_cylinder(3.12e-3, 2.96e-3, 100)).self_intersections, 0U);
}

TEST(Check, SeparateBodiesAreRefusedAndCavitiesKept) {
    const std::string words = refusal_of(test::joined(cube(), test::moved(cube(), {10e-3, 0, 0})));
    EXPECT_TRUE(mentions(words, "2 separate bodies")) << words;

    const TriangleMesh inner = make_box({0.5e-3, 0.5e-3, 0.5e-3}, {1e-3, 1e-3, 1e-3});
    const TriangleMesh hollow = test::joined(cube(), test::flipped(inner));
    EXPECT_TRUE(check(hollow).is_closed_body()) << check(hollow).summary();
    EXPECT_EQ(check(hollow).shells, 2U);
    const CheckedMesh checked = require_closed_body(test::joined(cube(), inner));  // the cavity's triangles point the wrong way
    EXPECT_TRUE(checked.report.is_closed_body());
    EXPECT_NEAR(checked.report.volume, 8e-9 - 0.125e-9, 1e-20);
    EXPECT_TRUE(mentions(checked.report.repairs.at(0), "cavities inward"));
}

TEST(Check, SurfacesThatTouchThemselvesAreRefused) {
    // Two cubes that share an edge: four triangles meet there.
    TriangleMesh edge = test::joined(cube(), test::moved(cube(), {2e-3, 2e-3, 0}));
    EXPECT_TRUE(mentions(refusal_of(edge), "more than two triangles")) << refusal_of(edge);
    // Two cubes that share a corner.
    TriangleMesh corner = test::joined(cube(), test::moved(cube(), {2e-3, 2e-3, 2e-3}));
    const std::string words = refusal_of(corner);
    EXPECT_TRUE(mentions(words, "touches itself")) << words;
}

TEST(Check, FlatAndTinyAndHugeBodiesAreRefused) {
    TriangleMesh flat = cube();
    for (Vec3& v : flat.vertices) v.z() = 1e-3;
    EXPECT_TRUE(mentions(refusal_of(flat), "flat")) << refusal_of(flat);
    TriangleMesh tilted = flat;  // no box edge is zero
    for (Vec3& v : tilted.vertices) v = Quat(Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized())) * v;
    refusal_of(tilted);

    TriangleMesh huge = cube(), tiny = cube();
    for (Vec3& v : huge.vertices) v *= 1e3;
    for (Vec3& v : tiny.vertices) v *= 1e-4;
    const std::string words = refusal_of(huge);
    EXPECT_TRUE(mentions(words, "2 m large") && mentions(words, "unit")) << words;
    EXPECT_TRUE(mentions(refusal_of(tiny), "0.2 um large")) << refusal_of(tiny);
}

TEST(Check, RefusesWhatIsNoMesh) {
    test::refusal([] { check({}); });
    TriangleMesh bad = cube();
    bad.faces[3][1] = 99;
    EXPECT_TRUE(mentions(test::refusal([&] { check(bad); }), "vertex 100"));
    bad = cube();
    bad.vertices[bad.faces[2][0]].y() = std::nan("");
    EXPECT_TRUE(mentions(test::refusal([&] { check(bad); }), "finite"));
}

TEST(Check, OneSidedSurfaceIsRefused) {
    // A Möbius strip of 12 quads: open, and no orientation fits.
    TriangleMesh strip;
    const std::uint32_t n = 12;
    for (std::uint32_t k = 0; k < n; ++k) {
        const double angle = 2 * M_PI * k / n, half = 0.5 * angle;
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        const Vec3 across = 0.3e-3 * (std::cos(half) * out + std::sin(half) * Vec3::UnitZ());
        strip.vertices.push_back(1e-3 * out - across);
        strip.vertices.push_back(1e-3 * out + across);
    }
    for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t a = 2 * k, b = a + 1, c = k + 1 < n ? a + 2 : 1, d = k + 1 < n ? a + 3 : 0;
        strip.faces.push_back({a, c, b});
        strip.faces.push_back({b, c, d});
    }
    EXPECT_GT(check(strip).inconsistent_edges, 0U);
    refusal_of(strip);
}

}  // namespace
}  // namespace pelletlab::meshes
