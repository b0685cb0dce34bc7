#include "shapegen/detail/match_moments.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "shapegen/detail/union_boundary.hpp"

namespace pelletlab::shapegen::detail {

namespace {

struct Union {
    double volume, area;
    Vec3 centre;
    Mat3 covariance;
};

Union measure(const std::vector<Sphere>& spheres, const Vec3& origin) {
    const std::vector<ExposedPart> boundary = union_boundary(spheres);
    const UnionMoments moments = union_moments(spheres, boundary, origin);
    Union result{moments.volume, 0.0, Vec3::Zero(), Mat3::Zero()};
    for (std::size_t i = 0; i < spheres.size(); ++i) result.area += spheres[i].radius * spheres[i].radius * boundary[i].solid_angle;
    const Vec3 mean = moments.first / moments.volume;
    result.centre = origin + mean;
    result.covariance = moments.second / moments.volume - mean * mean.transpose();
    return result;
}

void add_to_radii(std::vector<Sphere>& spheres, double offset, double min_radius) {
    for (Sphere& sphere : spheres) sphere.radius = std::max(sphere.radius + offset, std::max(min_radius, 1e-3 * sphere.radius));
}

constexpr double largest_offset = 0.05;  // × size of the body, of the radii beside a stretch; usual are 1e-3

// Stretch of the centres along three axes and radius offset, and what they leave: relative errors of the spread along the axes and of the volume.
using Unknowns = Eigen::Vector4d;

std::vector<Sphere> changed(const std::vector<Sphere>& spheres, const Mat3& axes, const Vec3& centre, const Unknowns& u, double min_radius) {
    std::vector<Sphere> result = spheres;
    for (Sphere& sphere : result) {
        const Vec3 local = axes.transpose() * (sphere.centre - centre);
        sphere.centre += axes * u.head<3>().cwiseProduct(local);
    }
    add_to_radii(result, u[3], min_radius);
    return result;
}

Eigen::Vector4d errors(const std::vector<Sphere>& spheres, const Mat3& axes, const Vec3& wanted, const BodyMoments& body) {
    const Union now = measure(spheres, body.centre);
    Eigen::Vector4d error;
    error << (axes.transpose() * now.covariance * axes).diagonal().cwiseQuotient(wanted) - Vec3::Ones(), now.volume / body.volume - 1.0;
    return error;
}

// Radius offset alone, until the volume is met.
void match_volume(std::vector<Sphere>& spheres, const BodyMoments& body, double min_radius) {
    for (int round = 0; round < 30; ++round) {
        const Union now = measure(spheres, body.centre);
        const double missing = body.volume - now.volume;
        if (std::abs(missing) < 1e-11 * body.volume) return;
        add_to_radii(spheres, missing / now.area, min_radius);
    }
}

}  // namespace

void match_moments(std::vector<Sphere>& spheres, const BodyMoments& body, const MatchSettings& settings) {
    if (settings.volume) match_volume(spheres, body, settings.min_radius);
    if (!settings.centre_and_inertia) return;
    const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(body.covariance).eigenvectors();
    const Vec3 wanted = (axes.transpose() * body.covariance * axes).diagonal();
    const Vec3 centre = measure(spheres, body.centre).centre;
    const std::vector<Sphere> start = spheres;
    const double size = std::cbrt(body.volume);

    Unknowns u = Unknowns::Zero();
    Eigen::Vector4d error = errors(start, axes, wanted, body);
    Eigen::Matrix4d slope;
    for (int k = 0; k < 4; ++k) {
        Unknowns step = Unknowns::Zero();
        step[k] = k < 3 ? 1e-4 : 1e-4 * size;
        slope.col(k) = (errors(changed(start, axes, centre, step, settings.min_radius), axes, wanted, body) - error) / step[k];
    }
    if (!settings.volume) {  // the radii stay
        slope.row(3) << 0.0, 0.0, 0.0, 1.0;
        slope.col(3).head<3>().setZero();
    }
    // Few spheres may not react to a stretch at all: the shortest solution.
    const Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix4d> solver(slope);
    for (int round = 0; round < 12; ++round) {
        if (!settings.volume) error[3] = 0.0;
        if (error.cwiseAbs().maxCoeff() < 1e-11) break;
        u -= solver.solve(error);
        for (int k = 0; k < 3; ++k) u[k] = std::clamp(u[k], -settings.largest_stretch, settings.largest_stretch);
        if (!(std::abs(u[3]) < largest_offset * size)) return;  // no way from here: the volume alone is met
        error = errors(changed(start, axes, centre, u, settings.min_radius), axes, wanted, body);
    }
    spheres = changed(start, axes, centre, u, settings.min_radius);
    if (settings.volume) match_volume(spheres, body, settings.min_radius);
    const Vec3 shift = body.centre - measure(spheres, body.centre).centre;
    for (Sphere& sphere : spheres) sphere.centre += shift;
}

}  // namespace pelletlab::shapegen::detail
