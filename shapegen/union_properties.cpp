// Method: divergence theorem over the exposed part of every sphere, whose boundary of circle arcs gives all integrals in closed form
// (detail/union_boundary.hpp). Rounding is the only error, about 1e-13 relative.
#include "shapegen/union_properties.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "shapegen/detail/union_boundary.hpp"

namespace pelletlab::shapegen {

namespace {

// Middle of the spheres' box: moments about it lose little to cancellation.
Vec3 middle_of(std::span<const Sphere> spheres) {
    Box box;
    for (const Sphere& sphere : spheres) {
        if (!(sphere.radius > 0.0) || !sphere.centre.allFinite())
            throw bad_input("a sphere has no positive radius or no finite centre", "remove it from the list");
        box.extend(sphere.centre);
    }
    return box.center();
}

// Right-handed axes, moments ascending, except that a body of two equal moments has its axis of symmetry as z. Signs: the largest component of each axis
// is positive.
void principal_axes(const Mat3& inertia, Quat& axes, Vec3& moments) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
    moments = solver.eigenvalues();
    Mat3 frame = solver.eigenvectors();
    const double equal = 1e-6 * moments[2];
    if (moments[2] - moments[1] < equal && moments[1] - moments[0] >= equal) {  // the odd one out is the smallest: turn it to z
        moments = Vec3(moments[1], moments[2], moments[0]);
        Mat3 turned;
        turned << frame.col(1), frame.col(2), frame.col(0);
        frame = turned;
    } else if (moments[2] - moments[0] < equal) {
        frame = Mat3::Identity();  // every axis is a principal axis
    }
    const bool two_equal = moments[1] - moments[0] < equal && moments[0] - moments[1] < equal;
    Eigen::Index largest = 0;
    frame.col(2).cwiseAbs().maxCoeff(&largest);
    if (frame(largest, 2) < 0.0) frame.col(2) *= -1.0;
    if (two_equal && moments[2] != moments[0]) {  // x and y are free in their plane: take the x axis of the frame as far as it goes
        const Vec3 z = frame.col(2);
        Vec3 x = Vec3::UnitX() - z * z.x();
        if (x.norm() < 1e-3) x = Vec3::UnitY() - z * z.y();
        frame.col(0) = x.normalized();
    } else {
        frame.col(0).cwiseAbs().maxCoeff(&largest);
        if (frame(largest, 0) < 0.0) frame.col(0) *= -1.0;
    }
    frame.col(1) = frame.col(2).cross(frame.col(0));
    axes = Quat(frame).normalized();
}

void check_density(double density) {
    if (!(density > 0.0) || !std::isfinite(density)) throw bad_input("the density must be positive", "give it in kg/m^3");
}

// Mass properties from the integrals of 1, x and x xᵀ about the origin.
MassProperties weighed(const detail::UnionMoments& moments, const Vec3& origin, double density) {
    MassProperties mass;
    mass.volume = moments.volume;
    mass.density = density;
    mass.mass = density * moments.volume;
    const Vec3 centre = moments.first / moments.volume;
    mass.centre_of_mass_mesh = origin + centre;
    const Mat3 spread = moments.second - moments.volume * centre * centre.transpose();
    principal_axes(density * (spread.trace() * Mat3::Identity() - spread), mass.principal_axes, mass.principal_inertia);
    return mass;
}

}  // namespace

MassProperties union_mass_properties(std::span<const Sphere> spheres, double density) {
    if (spheres.empty()) throw bad_input("a union of no spheres has no mass", "give at least one sphere");
    check_density(density);
    const Vec3 origin = middle_of(spheres);
    const detail::UnionMoments moments = detail::union_moments(spheres, detail::union_boundary(spheres), origin);
    if (!(moments.volume > 0.0)) throw numerical_failure("the union of spheres has no volume", "check the radii");
    return weighed(moments, origin, density);
}

MassProperties sum_mass_properties(std::span<const Sphere> spheres, double density) {
    if (spheres.empty()) throw bad_input("a sum of no spheres has no mass", "give at least one sphere");
    check_density(density);
    const Vec3 origin = middle_of(spheres);
    detail::UnionMoments moments;
    for (const Sphere& sphere : spheres) {
        const double volume = 4.0 / 3.0 * std::numbers::pi * sphere.radius * sphere.radius * sphere.radius;
        const Vec3 c = sphere.centre - origin;
        moments.volume += volume;
        moments.first += volume * c;
        moments.second += volume * (c * c.transpose() + 0.2 * sphere.radius * sphere.radius * Mat3::Identity());  // of a ball about its centre V r²/5
    }
    return weighed(moments, origin, density);
}

double union_volume(std::span<const Sphere> spheres) {
    if (spheres.empty()) return 0.0;
    return detail::union_moments(spheres, detail::union_boundary(spheres), middle_of(spheres)).volume;
}

}  // namespace pelletlab::shapegen
