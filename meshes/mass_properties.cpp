#include "meshes/mass_properties.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"

namespace pelletlab::meshes {
namespace {

/// Index of the largest absolute component; near ties go to the lower index so that rounding does not decide.
int dominant_axis(const Vec3& v) {
    int best = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(v[k]) > std::abs(v[best]) * (1.0 + 1e-9)) best = k;
    return best;
}

/// Unit vector with its dominant component positive, set to a coordinate axis when it is that already but for rounding.
Vec3 tidy_axis(Vec3 axis) {
    const int k = dominant_axis(axis);
    if (axis[k] < 0.0) axis = -axis;
    const Vec3 unit = Vec3::Unit(k);
    return (axis - unit).norm() < equal_moment_tolerance ? unit : axis;
}

/// The coordinate axis least aligned with z, made perpendicular to z.
Vec3 perpendicular_to(const Vec3& z) {
    int k = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(z[i]) < std::abs(z[k]) - 1e-9) k = i;
    const Vec3 unit = Vec3::Unit(k);
    return (unit - unit.dot(z) * z).normalized();
}

Quat rotation_of(const Vec3& x, const Vec3& y, const Vec3& z) {
    Mat3 matrix;
    matrix << x, y, z;
    Quat quaternion(matrix);
    quaternion.normalize();
    if (quaternion.w() < 0.0) quaternion.coeffs() = -quaternion.coeffs();
    return quaternion;
}

}  // namespace

VolumeMoments volume_moments(const TriangleMesh& mesh) {
    if (mesh.empty()) return {};
    // Tetrahedra from a point in the body's middle: a mesh far from its frame's origin loses no digits.
    const Vec3 reference = bounding_box(mesh).center();
    double six_volume = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 a = mesh.corner(f, 0) - reference, b = mesh.corner(f, 1) - reference, c = mesh.corner(f, 2) - reference;
        const double det = a.dot(b.cross(c));
        const Vec3 sum = a + b + c;
        six_volume += det;
        first += det * sum;
        second += det * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    VolumeMoments moments;
    moments.volume = six_volume / 6.0;
    if (six_volume == 0.0) return moments;
    const Vec3 offset = first / (4.0 * six_volume);
    moments.centroid = reference + offset;
    moments.second = second / 120.0 - moments.volume * offset * offset.transpose();
    return moments;
}

PrincipalFrame principal_frame(const Mat3& inertia) {
    const Mat3 symmetric = 0.5 * (inertia + inertia.transpose());
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(symmetric);
    const Vec3 moments = solver.eigenvalues();  // ascending
    const double tolerance = equal_moment_tolerance * moments[2];
    const bool low_pair = moments[1] - moments[0] <= tolerance;
    const bool high_pair = moments[2] - moments[1] <= tolerance;
    PrincipalFrame frame;
    if (low_pair && high_pair) {
        frame.moments = symmetric.diagonal();
    } else if (low_pair || high_pair) {
        const Vec3 z = tidy_axis(solver.eigenvectors().col(low_pair ? 2 : 0));
        const Vec3 x = perpendicular_to(z);
        frame.axes = rotation_of(x, z.cross(x), z);
        const double transverse = low_pair ? 0.5 * (moments[0] + moments[1]) : 0.5 * (moments[1] + moments[2]);
        frame.moments = {transverse, transverse, moments[low_pair ? 2 : 0]};
    } else {
        const Vec3 x = tidy_axis(solver.eigenvectors().col(0));
        const Vec3 y = tidy_axis(solver.eigenvectors().col(1));
        frame.axes = rotation_of(x, y, x.cross(y));
        frame.moments = moments;
    }
    return frame;
}

MassProperties mass_properties(const TriangleMesh& mesh, double density) {
    if (!(density > 0.0) || !std::isfinite(density))
        throw bad_input("the density of a body must be positive, but it is " + std::to_string(density) + " kg/m^3", "for instance density = \"1800 kg/m^3\"");
    if (mesh.empty()) throw bad_input("a mesh without triangles has no volume", "export the body again as triangles");
    const VolumeMoments moments = volume_moments(mesh);
    const double extent = bounding_box(mesh).sizes().maxCoeff();
    if (!(moments.volume > 1e-12 * extent * extent * extent))
        throw bad_input(moments.volume < 0.0 ? "the mesh is inside-out: its signed volume is negative" : "the mesh encloses no volume",
                        "pass the mesh through require_closed_body first");
    MassProperties properties;
    properties.volume = moments.volume;
    properties.density = density;
    properties.mass = density * moments.volume;
    properties.centre_of_mass_mesh = moments.centroid;
    const Mat3 inertia = density * (moments.second.trace() * Mat3::Identity() - moments.second);
    const PrincipalFrame frame = principal_frame(inertia);
    properties.principal_axes = frame.axes;
    properties.principal_inertia = frame.moments;
    return properties;
}

}  // namespace pelletlab::meshes
