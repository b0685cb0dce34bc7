#include "shapegen/union_properties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "shapegen/detail/union_boundary.hpp"
#include "shapegen/hand_made.hpp"

namespace pelletlab::shapegen {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double exact = 1e-12;  // relative; closed forms, so rounding only (the promise of the header is 1e-6)

double ball(double r) {
    return 4.0 / 3.0 * pi * r * r * r;
}

// ∫ of x^k π(r² − (x−c)²) dx over [a, b]: volume and moments of a slice of a ball on the x axis, exact for polynomials by Gauss–Legendre of 5 points.
double slice(double c, double r, double a, double b, int k) {
    const double nodes[5] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
    const double weights[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891, 0.2369268850561891};
    double sum = 0.0;
    for (int i = 0; i < 5; ++i) {
        const double x = 0.5 * (a + b) + 0.5 * (b - a) * nodes[i];
        sum += weights[i] * std::pow(x, k) * pi * (r * r - (x - c) * (x - c));
    }
    return 0.5 * (b - a) * sum;
}

// ∫ of y² over the discs of a slice: area²/(4π) each.
double slice_lateral(double c, double r, double a, double b) {
    const double nodes[5] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
    const double weights[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891, 0.2369268850561891};
    double sum = 0.0;
    for (int i = 0; i < 5; ++i) {
        const double x = 0.5 * (a + b) + 0.5 * (b - a) * nodes[i];
        const double area = pi * (r * r - (x - c) * (x - c));
        sum += weights[i] * area * area / (4.0 * pi);
    }
    return 0.5 * (b - a) * sum;
}

struct Expected {
    double volume, centre, axial, lateral;  // moments of inertia at density 1
};

// Spheres on the x axis, each met only by the next one: exact by slices between the planes of intersection.
Expected necklace(const std::vector<Sphere>& spheres) {
    double volume = 0.0, first = 0.0, second = 0.0, across = 0.0;
    double left = spheres.front().centre.x() - spheres.front().radius;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const double c = spheres[i].centre.x(), r = spheres[i].radius;
        double right = c + r;
        if (i + 1 < spheres.size()) {
            const double c2 = spheres[i + 1].centre.x(), r2 = spheres[i + 1].radius, d = c2 - c;
            right = c + (d * d + r * r - r2 * r2) / (2.0 * d);
        }
        volume += slice(c, r, left, right, 0);
        first += slice(c, r, left, right, 1);
        second += slice(c, r, left, right, 2);
        across += slice_lateral(c, r, left, right);
        left = right;
    }
    const double centre = first / volume;
    return {volume, centre, 2.0 * across, across + second - volume * centre * centre};
}

std::vector<Sphere> moved(std::vector<Sphere> spheres, const Pose& pose) {
    for (Sphere& sphere : spheres) sphere.centre = pose.to_world(sphere.centre);
    return spheres;
}

TEST(UnionProperties, OneSphere) {
    const std::vector<Sphere> one = {{{0.3, -0.2, 0.9}, 0.7}};
    const MassProperties mass = union_mass_properties(one, 2.0);
    const double m = 2.0 * ball(0.7);
    EXPECT_NEAR(mass.volume / ball(0.7), 1.0, exact);
    EXPECT_NEAR(mass.mass / m, 1.0, exact);
    EXPECT_LT((mass.centre_of_mass_mesh - one[0].centre).norm(), exact);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mass.principal_inertia[k] / (0.4 * m * 0.49), 1.0, exact);
}

TEST(UnionProperties, TwoAndThreeSpheresInARow) {
    const std::vector<std::vector<Sphere>> sets = {
        {{{0, 0, 0}, 1.0}, {{1.2, 0, 0}, 0.8}},
        {{{0, 0, 0}, 1.0}, {{0.5, 0, 0}, 1.0}},
        {{{0, 0, 0}, 1.0}, {{0.9, 0, 0}, 0.3}},  // the plane of intersection lies beyond the small centre
        {{{-1.5, 0, 0}, 1.0}, {{0, 0, 0}, 0.9}, {{1.4, 0, 0}, 0.7}},
    };
    const Pose pose{{3.0, -2.0, 1.0}, Quat(Eigen::AngleAxisd(0.83, Vec3(1, 2, -1).normalized()))};
    for (const auto& set : sets) {
        const Expected expected = necklace(set);
        const MassProperties mass = union_mass_properties(moved(set, pose), 1.0);
        EXPECT_NEAR(mass.volume / expected.volume, 1.0, exact);
        EXPECT_LT((mass.centre_of_mass_mesh - pose.to_world({expected.centre, 0, 0})).norm(), 1e-11);
        EXPECT_NEAR(mass.principal_inertia[0] / expected.lateral, 1.0, 1e-10);  // two equal moments first, the axis is z
        EXPECT_NEAR(mass.principal_inertia[1] / expected.lateral, 1.0, 1e-10);
        EXPECT_NEAR(mass.principal_inertia[2] / expected.axial, 1.0, 1e-10);
        const Vec3 axis = mass.principal_axes * Vec3::UnitZ();
        EXPECT_NEAR(std::abs(axis.dot(pose.orientation * Vec3::UnitX())), 1.0, 1e-10);
    }
}

// Three equal discs of radius q around an equilateral triangle of side d: area of their union and its derivative-free closed form.
double three_discs(double q, double d) {
    if (q <= 0.0) return 0.0;
    const double circle = pi * q * q;
    if (2.0 * q <= d) return 3.0 * circle;
    const double half = std::acos(0.5 * d / q);
    const double lens = 2.0 * q * q * half - 0.5 * d * std::sqrt(4.0 * q * q - d * d);
    double common = 0.0;
    if (q > d / std::sqrt(3.0)) {  // triangle between the inner corners of the lenses plus three circular segments
        const double corner = std::sqrt(q * q - 0.25 * d * d) - d / (2.0 * std::sqrt(3.0));  // distance of a corner from the middle
        const double side = std::sqrt(3.0) * corner;
        const double angle = 2.0 * std::asin(0.5 * side / q);
        common = std::sqrt(3.0) / 4.0 * side * side + 1.5 * q * q * (angle - std::sin(angle));
    }
    return 3.0 * circle - 3.0 * lens + common;
}

// ∫ f over [a, b] with the square-root ends of f smoothed by x = sin: composite Simpson.
template <class F>
double integrate(double a, double b, const F& f) {
    const int n = 4000;
    double sum = 0.0;
    for (int i = 0; i <= n; ++i) {
        const double s = pi * (static_cast<double>(i) / n - 0.5);
        const double x = 0.5 * (a + b) + 0.5 * (b - a) * std::sin(s);
        sum += (i == 0 || i == n ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0)) * f(x) * 0.5 * (b - a) * std::cos(s);
    }
    return sum * pi / n / 3.0;
}

TEST(UnionProperties, ThreeSpheresAroundATriangle) {
    const double d = 1.1, r = 1.0;
    const std::vector<Sphere> three = {{{0, 0, 0}, r}, {{d, 0, 0}, r}, {{0.5 * d, 0.5 * std::sqrt(3.0) * d, 0}, r}};
    const double triple = std::sqrt(r * r - d * d / 3.0), pair = std::sqrt(r * r - 0.25 * d * d);  // heights where the slice changes its form
    const auto area = [&](double z) { return three_discs(std::sqrt(r * r - z * z), d); };
    const auto area_zz = [&](double z) { return z * z * area(z); };
    const auto both_sides = [&](const auto& f) { return 2.0 * (integrate(0.0, triple, f) + integrate(triple, pair, f) + integrate(pair, r, f)); };
    const double volume = both_sides(area);
    const detail::UnionMoments moments = detail::union_moments(three, detail::union_boundary(three), Vec3::Zero());
    EXPECT_NEAR(moments.volume / volume, 1.0, 1e-8);  // the quadrature's own error is about 1e-9
    EXPECT_NEAR(moments.second(2, 2) / both_sides(area_zz), 1.0, 1e-8);
    const MassProperties mass = union_mass_properties(three, 1.0);
    EXPECT_LT((mass.centre_of_mass_mesh - Vec3(0.5 * d, d / (2.0 * std::sqrt(3.0)), 0)).norm(), exact);
    EXPECT_NEAR(mass.principal_inertia[0] / mass.principal_inertia[1], 1.0, 1e-10);  // three-fold axis
}

TEST(UnionProperties, ContainedAndCoincidentSpheresAddNothing) {
    const std::vector<Sphere> base = {{{0, 0, 0}, 1.0}, {{1.2, 0, 0}, 0.8}};
    const double volume = union_volume(base);
    auto more = base;
    more.push_back({{0.2, 0.1, 0}, 0.5});  // inside
    more.push_back({{0.2, 0, 0}, 0.8});    // inside, touching
    more.push_back(base[0]);               // twice
    more.push_back(base[1]);               //
    more.push_back({{0, 0, 0}, 0.999});    // concentric
    EXPECT_NEAR(union_volume(more) / volume, 1.0, exact);
    std::reverse(more.begin(), more.end());
    EXPECT_NEAR(union_volume(more) / volume, 1.0, exact);
}

TEST(UnionProperties, CirclesInCommonAreCountedOnce) {
    // Three spheres through one circle: the middle one shows nothing but adds nothing either.
    const double h = 0.6, q = 0.8;  // circle of radius q in the plane x = 0
    const auto through = [&](double x) { return Sphere{{x, 0, 0}, std::hypot(x, q)}; };
    const double volume = union_volume(std::vector<Sphere>{through(-h), through(h)});
    EXPECT_NEAR(union_volume(std::vector<Sphere>{through(-h), through(0.1), through(h)}) / volume, 1.0, 1e-10);
    EXPECT_NEAR(union_volume(std::vector<Sphere>{through(0.1), through(h), through(-h), through(0.0)}) / volume, 1.0, 1e-10);
}

TEST(UnionProperties, ApartAndTouching) {
    EXPECT_NEAR(union_volume(std::vector<Sphere>{{{0, 0, 0}, 1.0}, {{5, 0, 0}, 0.5}}) / (ball(1.0) + ball(0.5)), 1.0, exact);
    EXPECT_NEAR(union_volume(std::vector<Sphere>{{{0, 0, 0}, 1.0}, {{1.5, 0, 0}, 0.5}}) / (ball(1.0) + ball(0.5)), 1.0, exact);
}

TEST(UnionProperties, VolumeDerivativeIsTheExposedArea) {
    // dV/dr_i = exposed area, dV/dc_i = r² ∫n: a check of the areas that closed forms of few spheres do not reach.
    RandomStream random(7, 0);
    std::vector<Sphere> spheres;
    for (int i = 0; i < 40; ++i) spheres.push_back({{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, random.uniform(0.3, 0.8)});
    const auto boundary = detail::union_boundary(spheres);
    const double h = 1e-5;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        auto plus = spheres, minus = spheres;
        plus[i].radius += h;
        minus[i].radius -= h;
        const double r2 = spheres[i].radius * spheres[i].radius;
        EXPECT_NEAR((union_volume(plus) - union_volume(minus)) / (2 * h), r2 * boundary[i].solid_angle, 1e-7) << i;
        plus = minus = spheres;
        plus[i].centre.y() += h;
        minus[i].centre.y() -= h;
        EXPECT_NEAR((union_volume(plus) - union_volume(minus)) / (2 * h), r2 * boundary[i].normal_integral.y(), 1e-7) << i;
    }
}

// Volume and moments by columns: exact along z, a grid in x and y.
detail::UnionMoments by_columns(const std::vector<Sphere>& spheres, double half_width, int n) {
    detail::UnionMoments moments;
    const double step = 2.0 * half_width / n;
    std::vector<std::pair<double, double>> pieces;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double x = -half_width + step * (i + 0.5), y = -half_width + step * (j + 0.5);
            pieces.clear();
            for (const Sphere& s : spheres) {
                const double d2 = s.radius * s.radius - (x - s.centre.x()) * (x - s.centre.x()) - (y - s.centre.y()) * (y - s.centre.y());
                if (d2 > 0) pieces.emplace_back(s.centre.z() - std::sqrt(d2), s.centre.z() + std::sqrt(d2));
            }
            std::sort(pieces.begin(), pieces.end());
            double reach = -1e9;
            for (const auto& [a, b] : pieces) {
                const double from = std::max(a, reach);
                if (b <= from) continue;
                const double length = (b - from) * step * step;
                moments.volume += length;
                moments.second(0, 0) += x * x * length;
                moments.second(2, 2) += (b * b * b - from * from * from) / 3.0 * step * step;
                reach = b;
            }
        }
    }
    return moments;
}

TEST(UnionProperties, Shape4AgainstColumns) {
    std::vector<Sphere> spheres = hand_made_shape(4);
    for (Sphere& s : spheres) {
        s.centre *= 1e3;
        s.radius *= 1e3;
    }
    const auto moments = detail::union_moments(spheres, detail::union_boundary(spheres), Vec3::Zero());
    const auto columns = by_columns(spheres, 1.57, 700);
    EXPECT_NEAR(moments.volume / columns.volume, 1.0, 2e-5);  // the columns themselves scatter by 5e-6 (350 to 2800 a side)
    EXPECT_NEAR(moments.second(0, 0) / columns.second(0, 0), 1.0, 4e-5);
    EXPECT_NEAR(moments.second(2, 2) / columns.second(2, 2), 1.0, 4e-5);
    EXPECT_NEAR(moments.volume / (pi * 1.56 * 1.56 * 2.96) - 1.0, -0.0874, 1e-4);  // clump_metrics.py
}

TEST(UnionProperties, SameBitsForOneAndTwoThreads) {
    const auto spheres = hand_made_shape(4);
    set_thread_count(1);
    const MassProperties one = union_mass_properties(spheres, 1800.0);
    set_thread_count(2);
    const MassProperties two = union_mass_properties(spheres, 1800.0);
    set_thread_count(0);
    EXPECT_EQ(one.volume, two.volume);
    EXPECT_EQ(one.principal_inertia, two.principal_inertia);
}

TEST(UnionProperties, NoSpheresAndBadRadiiAreErrors) {
    EXPECT_THROW(union_mass_properties(std::vector<Sphere>{}, 1.0), Error);
    EXPECT_THROW(union_volume(std::vector<Sphere>{{{0, 0, 0}, 0.0}}), Error);
    EXPECT_THROW(union_volume(std::vector<Sphere>{{{0, 0, std::nan("")}, 1.0}}), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
