#include "free_flight.hpp"

#include <Eigen/SVD>
#include <algorithm>

namespace pelletlab::crosscode {

FittedPose fit_pose(const std::vector<Sphere>& spheres, const std::vector<Vec3>& positions) {
    Vec3 mean_body = Vec3::Zero(), mean_world = Vec3::Zero();
    const double n = static_cast<double>(spheres.size());
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        mean_body += spheres[i].centre / n;
        mean_world += positions[i] / n;
    }
    Mat3 covariance = Mat3::Zero();
    for (std::size_t i = 0; i < spheres.size(); ++i) covariance += (positions[i] - mean_world) * (spheres[i].centre - mean_body).transpose();
    const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
    const Mat3 turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    FittedPose fitted;
    fitted.pose = {mean_world - turn * mean_body, Quat(turn).normalized()};
    for (std::size_t i = 0; i < spheres.size(); ++i) fitted.worst = std::max(fitted.worst, (fitted.pose.to_world(spheres[i].centre) - positions[i]).norm());
    return fitted;
}

Quat free_rotation(const Quat& start, const Vec3& spin_world, const Vec3& principal_inertia, double time) {
    const Vec3 momentum = start * principal_inertia.cwiseProduct(start.conjugate() * spin_world);
    const auto rate = [&](const Eigen::Vector4d& c) {
        const Quat q = Quat(c).normalized();
        const Vec3 spin = q * (q.conjugate() * momentum).cwiseQuotient(principal_inertia);
        return Eigen::Vector4d(0.5 * (Quat(0.0, spin.x(), spin.y(), spin.z()) * q).coeffs());
    };
    constexpr int steps = 20'000;
    const double h = time / steps;
    Eigen::Vector4d c = start.coeffs();
    for (int i = 0; i < steps; ++i) {
        const Eigen::Vector4d k1 = rate(c), k2 = rate(c + 0.5 * h * k1), k3 = rate(c + 0.5 * h * k2), k4 = rate(c + h * k3);
        c += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        c.normalize();
    }
    return Quat(c);
}

double spin_energy(const Quat& orientation, const Vec3& spin_world, const Vec3& principal_inertia) {
    const Vec3 spin = orientation.conjugate() * spin_world;
    return 0.5 * spin.dot(principal_inertia.cwiseProduct(spin));
}

}  // namespace pelletlab::crosscode
