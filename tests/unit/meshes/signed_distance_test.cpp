// Signed distance against closed forms and against brute force; the grid within the bound that it states.
#include "meshes/signed_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "meshes/detail/fast_winding.hpp"
#include "meshes/detail/winding.hpp"
#include "meshes/makers.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

const Vec3 half(1e-3, 1.5e-3, 0.7e-3);
TriangleMesh test_box() {
    return make_box(-half, half);
}

double box_distance(const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - half;
    return q.cwiseMax(0.0).norm() + std::min(0.0, q.maxCoeff());
}

std::vector<Vec3> cloud(std::size_t n, double reach, std::uint64_t stream = 0) {
    RandomStream random(11, stream);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach), z = random.uniform(-reach, reach);
        points.emplace_back(x, y, z);
    }
    return points;
}

/// A ring of two triangles' worth of concave and convex edges: an L-shaped bar, extruded along z.
TriangleMesh l_bar() {
    const std::array<std::array<double, 2>, 6> outline = {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
    TriangleMesh mesh;
    for (const double z : {-0.5, 0.5})
        for (const auto& [x, y] : outline) mesh.vertices.emplace_back(1e-3 * x, 1e-3 * y, 1e-3 * z);
    for (const auto& [a, b, c] : std::array<std::array<std::uint32_t, 3>, 4>{{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}}) {
        mesh.faces.push_back({a + 6, b + 6, c + 6});
        mesh.faces.push_back({a, c, b});
    }
    for (std::uint32_t k = 0; k < 6; ++k) {
        const std::uint32_t next = (k + 1) % 6;
        mesh.faces.push_back({k, next, next + 6});
        mesh.faces.push_back({k, next + 6, k + 6});
    }
    return mesh;
}

TEST(ExactDistance, BoxEverywhere) {
    const auto distance = exact_signed_distance(test_box());
    for (const Vec3& p : cloud(20000, 3e-3)) ASSERT_NEAR(distance->value(p), box_distance(p), 1e-17) << p.transpose();
    EXPECT_LT(distance->error_bound(), 1e-16);
}

TEST(ExactDistance, SignOverSharpEdgesAndCorners) {
    // Points whose nearest feature is a corner or an edge, at distances down to a femtometre: the face normals there disagree.
    const auto distance = exact_signed_distance(test_box());
    for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12}) {
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            const Vec3 at = half.cwiseProduct(side);
            for (const Vec3& direction : {Vec3(1, 1, 1), Vec3(1, 0.01, 0.01), Vec3(0.01, 0.01, 1), Vec3(1, 1, 0.01)}) {
                const Vec3 out = direction.cwiseProduct(side).normalized();
                EXPECT_NEAR(distance->value(at + gap * out), gap, 1e-17);
                EXPECT_LT(distance->value(at - gap * out), 0.0);
            }
            const Vec3 on_edge = at.cwiseProduct(Vec3(1, 1, 0.3)), out = Vec3(side.x(), side.y(), 0).normalized();
            EXPECT_NEAR(distance->value(on_edge + gap * out), gap, 1e-17);
            EXPECT_LT(distance->value(on_edge - gap * out), 0.0);
        }
    }
}

TEST(ExactDistance, SignOfConcaveBodyIsThatOfTheWindingNumber) {
    const TriangleMesh mesh = l_bar();
    const auto distance = exact_signed_distance(mesh);
    std::size_t inside = 0;
    for (const Vec3& p : cloud(20000, 2.5e-3, 1)) {
        const double value = distance->value(p), winding = detail::winding_number(mesh, p, [](std::size_t) { return true; });
        ASSERT_EQ(value<0.0, winding> 0.5) << p.transpose();
        inside += value < 0.0;
    }
    EXPECT_GT(inside, 300U);
    // Right at the concave edge the outside is a quarter.
    EXPECT_NEAR(distance->value({1.001e-3, 1.001e-3, 0}), 1e-6, 1e-17);
    EXPECT_NEAR(distance->value({0.999e-3, 0.999e-3, 0}), -std::sqrt(2.0) * 1e-6, 1e-17);
}

TEST(ExactDistance, SphereWithinItsFacets) {
    const double r = 1e-3;
    const auto distance = exact_signed_distance(make_sphere(2 * r, 4));
    // Sagitta of the longest edge, about 1.2 · 1.05 r/16: 0.8e-3 r.
    for (const Vec3& p : cloud(5000, 2e-3, 2)) {
        const double value = distance->value(p), truth = p.norm() - r;
        EXPECT_GE(value, truth - 1e-17);
        EXPECT_LE(value, truth + 1.2e-3 * r);
    }
}

TEST(ExactDistance, IsBruteForceOverTriangles) {
    const TriangleMesh mesh = make_cylinder(3.12e-3, 2.96e-3, 30);
    const auto distance = exact_signed_distance(mesh);
    const auto point_triangle = [&](const Vec3& p, std::size_t f) {  // Ericson (2005), Real-Time Collision Detection, section 5.1.5
        const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2), ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
        const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
        if (d1 <= 0 && d2 <= 0) return ap.norm();
        if (d3 >= 0 && d4 <= d3) return bp.norm();
        if (d6 >= 0 && d5 <= d6) return cp.norm();
        const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
        if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
        if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
        if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
        const double scale = 1 / (va + vb + vc);
        return (ap - vb * scale * ab - vc * scale * ac).norm();
    };
    for (const Vec3& p : cloud(1500, 2.5e-3, 3)) {
        double nearest = 1.0;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) nearest = std::min(nearest, point_triangle(p, f));
        ASSERT_NEAR(std::abs(distance->value(p)), nearest, 2e-17);
    }
}

TEST(ExactDistance, GradientPointsToTheNearestPoint) {
    const TriangleMesh mesh = l_bar();
    const auto distance = exact_signed_distance(mesh);
    for (const Vec3& p : cloud(5000, 2.5e-3, 4)) {
        const DistanceSample s = distance->sample(p);
        EXPECT_EQ(s.value, distance->value(p));
        EXPECT_NEAR(s.gradient.norm(), 1.0, 1e-12);
        EXPECT_NEAR(distance->value(p - s.value * s.gradient), 0.0, 1e-17);
    }
    // On the surface: the normal there, and between two normals on an edge.
    const auto box = exact_signed_distance(test_box());
    EXPECT_LT((box->gradient({half.x(), 0.1e-3, 0.2e-3}) - Vec3::UnitX()).norm(), 1e-12);
    EXPECT_LT((box->gradient({half.x(), half.y(), 0.2e-3}) - Vec3(1, 1, 0).normalized()).norm(), 1e-12);
    EXPECT_LT((box->gradient(half) - Vec3(1, 1, 1).normalized()).norm(), 1e-12);
}

TEST(ExactDistance, CavityIsOutside) {
    const TriangleMesh hollow = test::joined(make_box(-half, half), test::flipped(make_box(-0.5 * half, 0.5 * half)));
    const auto distance = exact_signed_distance(hollow);
    EXPECT_NEAR(distance->value(Vec3::Zero()), 0.35e-3, 1e-17);
    EXPECT_LT(distance->value({0, 0, 0.5e-3}), 0.0);
}

TEST(ExactDistance, ManyThreadsGiveTheSameBits) {
    const auto distance = exact_signed_distance(make_cylinder(3.12e-3, 2.96e-3, 48));
    const std::vector<Vec3> points = cloud(20000, 2.5e-3, 5);
    set_thread_count(1);
    const std::vector<double> alone = distance->values(points);
    set_thread_count(4);
    const std::vector<double> together = distance->values(points);
    const auto again = exact_signed_distance(make_cylinder(3.12e-3, 2.96e-3, 48))->values(points);
    set_thread_count(0);
    EXPECT_EQ(alone, together);
    EXPECT_EQ(alone, again);
    for (std::size_t i = 0; i < points.size(); i += 100) EXPECT_EQ(alone[i], distance->value(points[i]));
}

TEST(ExactDistance, RefusesOpenAndMixedMeshes) {
    TriangleMesh open = test_box(), mixed = test_box();
    open.faces.pop_back();
    std::swap(mixed.faces[0][0], mixed.faces[0][1]);
    test::refusal([&] { exact_signed_distance(open); });
    test::refusal([&] { exact_signed_distance(mixed); });
    test::refusal([&] { exact_signed_distance({}); });
    test::refusal([&] { grid_signed_distance(open, 1e-4); });
}

TEST(WindingDistance, AgreesWithTheExactOneOnClosedMeshes) {
    for (const TriangleMesh& mesh : {make_cylinder(3.12e-3, 2.96e-3, 32), l_bar(), make_sphere(2e-3, 3)}) {
        const auto exact = exact_signed_distance(mesh), winding = winding_signed_distance(mesh);
        for (const Vec3& p : cloud(5000, 2.5e-3, 9)) {
            ASSERT_EQ(exact->value(p), winding->value(p)) << p.transpose();
            ASSERT_LT((exact->gradient(p) - winding->gradient(p)).norm(), 1e-12);
        }
    }
}

TEST(WindingDistance, TreeIsOffByLessThanAHundredth) {
    for (TriangleMesh mesh : {make_cylinder(3.12e-3, 2.96e-3, 32), make_sphere(2e-3, 4)}) {
        mesh.faces.resize(mesh.faces.size() * 2 / 3);  // open
        const detail::FastWinding fast(mesh);
        for (const Vec3& p : cloud(1000, 4e-3, 10))
            ASSERT_NEAR(fast(p), detail::winding_number(mesh, p, [](std::size_t) { return true; }), 0.01) << p.transpose();
    }
}

TEST(WindingDistance, OpenAndCrossingMeshesHaveAnInside) {
    TriangleMesh open = make_sphere(2e-3, 3);
    open.faces.resize(open.faces.size() - 40);
    const auto distance = winding_signed_distance(open);
    std::size_t wrong = 0;
    const std::vector<Vec3> points = cloud(4000, 1.5e-3, 11);
    for (const Vec3& p : points) wrong += (distance->value(p) < 0.0) != (p.norm() < 1e-3);
    EXPECT_LT(wrong, points.size() / 50);  // points in the mouth of the hole, 3 % of the surface
    EXPECT_LT(distance->value(Vec3::Zero()), 0.0);

    // Two crossing boxes: inside is what lies in either.
    const auto boxes = winding_signed_distance(test::joined(make_box({0, 0, 0}, {2e-3, 2e-3, 2e-3}), make_box({1e-3, 1e-3, 1e-3}, {3e-3, 3e-3, 3e-3})));
    EXPECT_LT(boxes->value({1.5e-3, 1.5e-3, 1.5e-3}), 0.0);
    EXPECT_LT(boxes->value({0.5e-3, 0.5e-3, 0.5e-3}), 0.0);
    EXPECT_GT(boxes->value({2.5e-3, 0.5e-3, 0.5e-3}), 0.0);
    test::refusal([] { winding_signed_distance({}); });
}

class GridDistance : public testing::TestWithParam<GridFill> {};
INSTANTIATE_TEST_SUITE_P(Fill, GridDistance, testing::Values(GridFill::exact_query, GridFill::exact_band, GridFill::openvdb), [](const auto& test) {
    return std::string(test.param == GridFill::openvdb ? "openvdb" : test.param == GridFill::exact_band ? "exact_band" : "exact_query");
});

TEST_P(GridDistance, StaysWithinItsBoundInsideItsBox) {
    const double voxel = 0.15e-3;
    for (const TriangleMesh& mesh : {make_cylinder(3.12e-3, 2.96e-3, 32, true), test_box(), make_sphere(2e-3, 3), l_bar()}) {
        const auto exact = exact_signed_distance(mesh), grid = grid_signed_distance(mesh, voxel, GetParam());
        const Box box = bounding_box(mesh);
        const double rim = std::max(0.25 * box.sizes().minCoeff(), 3 * voxel);
        double largest = 0.0;
        for (const Vec3& p : cloud(40000, 1.0, 6)) {
            const Vec3 q = box.center() + p.cwiseProduct(0.5 * box.sizes() + Vec3::Constant(rim));
            largest = std::max(largest, std::abs(grid->value(q) - exact->value(q)));
        }
        EXPECT_LE(largest, grid->error_bound());
        EXPECT_GT(largest, 0.1 * grid->error_bound()) << "the bound is empty talk";
        EXPECT_LT(grid->error_bound(), (GetParam() == GridFill::openvdb ? 3.0 : 0.87) * voxel);
    }
}

TEST_P(GridDistance, WholeInteriorIsFilled) {
    // A narrow band of 3 voxels would say −0.6 mm in the middle. The facets of this sphere lie up to 0.01 mm inside it.
    const auto grid = grid_signed_distance(make_sphere(4e-3, 3), 0.2e-3, GetParam());
    EXPECT_NEAR(grid->value(Vec3::Zero()), -2e-3, 0.2e-3);
    EXPECT_NEAR(grid->value({1e-3, 0, 0}), -1e-3, 0.05e-3);
    EXPECT_NEAR(grid->value({0, 2.5e-3, 0}), 0.5e-3, 0.05e-3);
}

TEST(GridDistanceField, TheBandHoldsTheSameDistancesAsTheWholeGrid) {
    for (const TriangleMesh& mesh : {make_cylinder(3.12e-3, 2.96e-3, 32, true), l_bar()}) {
        const std::shared_ptr<const SignedDistance> exact = exact_signed_distance(mesh);
        const auto whole = grid_signed_distance(mesh, 0.15e-3), band = grid_signed_distance(mesh, 0.15e-3, GridFill::exact_band, exact);
        std::size_t near = 0;
        for (const Vec3& p : cloud(20000, 2.2e-3, 12)) {
            const bool in_band = std::abs(whole->value(p)) < (4.0 - std::sqrt(3.0)) * 0.15e-3;
            near += in_band ? 1 : 0;
            ASSERT_EQ(band->value(p), in_band ? whole->value(p) : exact->value(p)) << p.transpose();
        }
        EXPECT_GT(near, 1000u);
        EXPECT_LT(near, 18000u);
    }
}

TEST(GridDistanceField, ErrorShrinksWithTheVoxel) {
    const TriangleMesh mesh = make_cylinder(3.12e-3, 2.96e-3, 48, true);
    const double coarse = grid_signed_distance(mesh, 0.2e-3)->error_bound(), fine = grid_signed_distance(mesh, 0.05e-3)->error_bound();
    EXPECT_LT(fine, 0.5 * coarse);
}

TEST(GridDistanceField, GradientIsThatOfTheInterpolatedValue) {
    const auto grid = grid_signed_distance(make_cylinder(3.12e-3, 2.96e-3, 48, true), 0.1e-3);
    const double step = 1e-9;
    std::size_t compared = 0;
    for (const Vec3& p : cloud(3000, 5e-3, 7)) {  // half of them beyond the grid's box
        const DistanceSample s = grid->sample(p);
        EXPECT_EQ(s.value, grid->value(p));
        Vec3 numeric;
        bool smooth = true;
        for (int k = 0; k < 3; ++k) {
            const Vec3 e = step * Vec3::Unit(k);
            const double forward = (grid->value(p + e) - s.value) / step, backward = (s.value - grid->value(p - e)) / step;
            smooth = smooth && std::abs(forward - backward) < 1e-4;  // else the step crosses into the next cell
            numeric[k] = 0.5 * (forward + backward);
        }
        if (!smooth) continue;
        ++compared;
        ASSERT_LT((numeric - s.gradient).norm(), 1e-5) << p.transpose();
    }
    EXPECT_GT(compared, 2900U);
}

TEST(GridDistanceField, FarAwayIsAnUpperBoundThatGrowsWithTheWay) {
    const TriangleMesh mesh = make_cylinder(3.12e-3, 2.96e-3, 48, true);
    const auto exact = exact_signed_distance(mesh), grid = grid_signed_distance(mesh, 0.1e-3);
    for (const Vec3& p : cloud(2000, 20e-3, 8)) {
        const double truth = exact->value(p), value = grid->value(p);
        EXPECT_GE(value, truth - grid->error_bound());
        EXPECT_LE(value, truth + 2.5e-3);  // twice the rim's diagonal
    }
}

TEST(GridDistanceField, RefusesVoxelsThatCannotWork) {
    const TriangleMesh mesh = make_cylinder(3.12e-3, 2.96e-3, 24);
    test::refusal([&] { grid_signed_distance(mesh, 0.0); });
    test::refusal([&] { grid_signed_distance(mesh, std::nan("")); });
    test::refusal([&] { grid_signed_distance(mesh, 2e-3); });
    test::refusal([&] { grid_signed_distance(mesh, 1e-6); });
    test::refusal([&] { grid_signed_distance({}, 1e-4); });
}

}  // namespace
}  // namespace pelletlab::meshes
