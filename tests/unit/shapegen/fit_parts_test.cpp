// The parts of the fit, each against a slow or exact twin.
#include <gtest/gtest.h>

#include <cmath>

#include "analytic_cylinder.hpp"
#include "core/random.hpp"
#include "meshes/makers.hpp"
#include "shapegen/detail/gap_loss.hpp"
#include "shapegen/detail/lbfgs.hpp"
#include "shapegen/detail/match_moments.hpp"
#include "shapegen/detail/medial_balls.hpp"
#include "shapegen/detail/nearest_kernel.hpp"
#include "shapegen/detail/seeding.hpp"
#include "shapegen/detail/settle.hpp"
#include "shapegen/detail/symmetric_loss.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen::detail {
namespace {

// Cylinder of volume 1 with the pellet's proportions.
const double size_unit = std::cbrt(3.141592653589793 * 1.56 * 1.56 * 2.96);
const double unit_diameter = 3.12 / size_unit, unit_height = 2.96 / size_unit;

SampleBlocks cylinder_samples(std::size_t count) {
    return make_blocks(sample_surface(meshes::make_cylinder(unit_diameter, unit_height, 128, true), count, 3));
}

std::vector<Sphere> some_spheres(std::size_t count, std::uint64_t seed) {
    RandomStream random(seed, 0);
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < count; ++i) {
        spheres.push_back({{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)}, random.uniform(0.1, 0.4)});
    }
    return spheres;
}

TEST(NearestKernel, BothVersionsGiveTheSameBits) {
    RandomStream random(1, 0);
    SphereArrays spheres;
    spheres.resize(53);
    std::vector<std::uint32_t> candidates;
    for (std::size_t i = 0; i < 53; ++i) {
        spheres.x[i] = static_cast<float>(random.uniform(-1, 1));
        spheres.y[i] = static_cast<float>(random.uniform(-1, 1));
        spheres.z[i] = static_cast<float>(random.uniform(-1, 1));
        spheres.radius[i] = static_cast<float>(random.uniform(0.1, 1));
        candidates.push_back(static_cast<std::uint32_t>(52 - i));
    }
    for (int round = 0; round < 200; ++round) {
        float x[8], y[8], z[8], gap[8], gap_scalar[8], far[53], far_scalar[53];
        std::uint32_t nearest[8], nearest_scalar[8];
        for (int k = 0; k < 8; ++k) {
            x[k] = static_cast<float>(random.uniform(-2, 2));
            y[k] = static_cast<float>(random.uniform(-2, 2));
            z[k] = static_cast<float>(random.uniform(-2, 2));
        }
        const std::size_t count = 1 + static_cast<std::size_t>(random.uniform() * 52);
        nearest_of_candidates(x, y, z, candidates.data(), count, spheres, gap, nearest);
        nearest_of_candidates_scalar(x, y, z, candidates.data(), count, spheres, gap_scalar, nearest_scalar);
        distances_to_spheres(x[0], y[0], z[0], spheres, count, far);
        distances_to_spheres_scalar(x[0], y[0], z[0], spheres, count, far_scalar);
        for (int k = 0; k < 8; ++k) {
            EXPECT_EQ(gap[k], gap_scalar[k]);
            EXPECT_EQ(nearest[k], nearest_scalar[k]);
        }
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(far[i], far_scalar[i]);
    }
}

TEST(GapLoss, CandidatesFindTheNearestSphereWhileSpheresMove) {
    const SampleBlocks samples = cylinder_samples(3000);
    std::vector<Sphere> spheres = some_spheres(60, 2);
    GapLoss loss(samples, spheres);
    RandomStream random(4, 0);
    for (int step = 0; step < 12; ++step) {
        const double reach = step < 6 ? 1e-3 : 0.05;  // inside the margin of the candidates, and beyond it
        for (Sphere& sphere : spheres) {
            for (int k = 0; k < 3; ++k) sphere.centre[k] += random.uniform(-reach, reach);
            sphere.radius += random.uniform(-0.5 * reach, 0.5 * reach);
        }
        const double value = loss.evaluate(pack(spheres), nullptr, nullptr);
        double sum = 0.0;
        for (const Vec3& p : samples.points) {
            double gap = 1e9;
            for (const Sphere& sphere : spheres) gap = std::min(gap, (p - sphere.centre).norm() - sphere.radius);
            sum += gap * gap;
        }
        EXPECT_NEAR(value / (sum / static_cast<double>(samples.size())), 1.0, 1e-6) << step;  // ties within single precision
    }
}

TEST(GapLoss, GradientIsTheSlope) {
    const SampleBlocks samples = cylinder_samples(20000);
    const std::vector<Sphere> spheres = some_spheres(20, 7);
    GapLoss loss(samples, spheres);
    VectorXd x = pack(spheres), gradient, unused;
    loss.evaluate(x, &gradient, nullptr);
    const double h = 1e-5;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        VectorXd plus = x, minus = x;
        plus[i] += h;
        minus[i] -= h;
        const double slope = (loss.evaluate(plus, nullptr, nullptr) - loss.evaluate(minus, nullptr, nullptr)) / (2 * h);
        EXPECT_NEAR(slope, gradient[i], 1e-6 + 1e-3 * std::abs(gradient[i])) << i;
    }
}

TEST(SymmetricLoss, GradientIsTheSlope) {
    // The union's moving surface and creases: the sum over directions scatters by 1e-3 or so, hence many of them and a tolerance of a few percent of the
    // largest component. A missing crease term is off by 30 % and more.
    const AnalyticCylinder cylinder(unit_diameter, unit_height);
    const SampleBlocks samples = cylinder_samples(8000);
    std::vector<Sphere> spheres = seed_by_gaps(samples, cylinder, {16, 0.0, 0.5, 0.003});
    {
        GapLoss loss(samples, spheres);
        settle(loss, {20, 1e-3, 0.0, 0.05});
        loss.copy_spheres(spheres);
    }
    const double r = 0.5 * unit_diameter;
    const BodyMoments body{1.0, Vec3::Zero(), Vec3(0.25 * r * r, 0.25 * r * r, unit_height * unit_height / 12.0).asDiagonal()};
    SymmetricLoss loss(samples, cylinder, spheres, body, 200000);
    VectorXd x = pack(spheres), gradient, unused;
    loss.evaluate(x, gradient, nullptr);
    const double scale = gradient.cwiseAbs().maxCoeff(), h = 2e-5;
    for (Eigen::Index i = 0; i < 24; ++i) {
        VectorXd plus = x, minus = x;
        plus[i] += h;
        minus[i] -= h;
        const double slope = (loss.evaluate(plus, unused, nullptr) - loss.evaluate(minus, unused, nullptr)) / (2 * h);
        EXPECT_NEAR(slope, gradient[i], 0.02 * scale + 0.02 * std::abs(gradient[i])) << i;
    }
    loss.evaluate(x, unused, nullptr);
    EXPECT_NEAR(loss.union_volume(), union_volume(spheres), 1e-12);
}

TEST(Minimiser, RosenbrockAndBounds) {
    const Objective valley = [](const VectorXd& x, VectorXd& g, bool) {
        g.resize(2);
        const double a = 1.0 - x[0], b = x[1] - x[0] * x[0];
        g << -2.0 * a - 400.0 * x[0] * b, 200.0 * b;
        return a * a + 100.0 * b * b;
    };
    MinimiserSettings settings;
    settings.iterations = 300;
    settings.tolerance = 1e-14;
    settings.longest_step = 1.0;
    const double none = -std::numeric_limits<double>::infinity();
    VectorXd x(2), lower(2);
    x << -1.2, 1.0;
    lower << none, none;
    MinimiserResult result = minimise(
        x, lower, valley, [](VectorXd& q) { q *= 1e-3; }, settings);
    EXPECT_LT((x - VectorXd::Ones(2)).norm(), 1e-6);
    EXPECT_TRUE(result.converged);
    x << 2.0, 3.0;
    lower << 1.5, none;  // the least value at x ≥ 1.5 lies on the bound: (1.5, 2.25)
    minimise(
        x, lower, valley, [](VectorXd& q) { q *= 1e-3; }, settings);
    EXPECT_NEAR(x[0], 1.5, 1e-9);
    EXPECT_NEAR(x[1], 2.25, 1e-4);
}

TEST(BlockMetric, RankOneTermsAreInverted) {
    RandomStream random(5, 0);
    BlockMetric metric;
    const Eigen::Index n = 12;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
    double trace = 0.0;
    for (int b = 0; b < 3; ++b) {
        Eigen::Matrix4d a;
        for (int i = 0; i < 16; ++i) a(i / 4, i % 4) = random.uniform(-1, 1);
        metric.blocks.push_back(a * a.transpose());
        trace += metric.blocks.back().trace();
    }
    for (int b = 0; b < 3; ++b) {
        Eigen::Matrix4d damped = metric.blocks[static_cast<std::size_t>(b)];
        damped.diagonal().array() += 0.05 * trace / 12.0 + 1e-3 * metric.blocks[static_cast<std::size_t>(b)].trace();
        dense.block<4, 4>(4 * b, 4 * b) = damped;
    }
    for (const double scale : {3.0, 0.7, 20.0}) {
        VectorXd row(n);
        for (Eigen::Index i = 0; i < n; ++i) row[i] = random.uniform(-1, 1);
        metric.rows.push_back(row);
        metric.scales.push_back(scale);
        dense += scale * row * row.transpose();
    }
    metric.factorise(0.05);
    VectorXd q(n);
    for (Eigen::Index i = 0; i < n; ++i) q[i] = random.uniform(-1, 1);
    const VectorXd expected = dense.ldlt().solve(q);
    metric.apply(q);
    EXPECT_LT((q - expected).norm() / expected.norm(), 1e-9);
}

TEST(MedialBalls, OfACylinder) {
    const AnalyticCylinder cylinder(3.12, 2.96);
    // On a flat face at distance t from the rim the ball has radius t, up to half the height; on the side likewise.
    for (const double t : {0.1, 0.5, 1.2}) {
        EXPECT_NEAR(medial_radius(cylinder, {1.56 - t, 0, 1.48}, Vec3::UnitZ(), 1.5, 1e-4), t, 2e-3);
        EXPECT_NEAR(medial_radius(cylinder, {1.56, 0, 1.48 - t}, Vec3::UnitX(), 1.5, 1e-4), t, 2e-3);
    }
    EXPECT_NEAR(medial_radius(cylinder, {0, 0, 1.48}, Vec3::UnitZ(), 1.5, 1e-4), 1.48, 2e-3);
}

TEST(MatchMoments, VolumeCentreAndInertia) {
    std::vector<Sphere> spheres = some_spheres(80, 9);
    const MassProperties before = union_mass_properties(spheres, 1.0);
    const Mat3 axes = before.principal_axes.toRotationMatrix();
    const Vec3 inertia = before.principal_inertia / before.volume;
    const Vec3 spread = Vec3::Constant(0.5 * inertia.sum()) - inertia;
    // A body 1 % larger in volume, a little off centre, and a little longer along its first axis.
    const Vec3 wanted = spread.cwiseProduct(Vec3(1.008, 1.0066, 1.0066));
    const BodyMoments body{1.01 * before.volume, before.centre_of_mass_mesh + Vec3(1e-3, -2e-3, 0), axes * wanted.asDiagonal() * axes.transpose()};
    match_moments(spheres, body, {true, true, 0.0, 0.05});
    const MassProperties after = union_mass_properties(spheres, 1.0);
    EXPECT_NEAR(after.volume / body.volume, 1.0, 1e-8);
    EXPECT_LT((after.centre_of_mass_mesh - body.centre).norm(), 1e-8);
    Vec3 moments = Vec3::Constant(wanted.sum()) - wanted;
    std::sort(moments.data(), moments.data() + 3);
    Vec3 have = after.principal_inertia / after.volume;
    std::sort(have.data(), have.data() + 3);
    EXPECT_LT((have - moments).norm() / moments.norm(), 1e-6);
}

}  // namespace
}  // namespace pelletlab::shapegen::detail
