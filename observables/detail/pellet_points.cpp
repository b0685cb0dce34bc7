#include "observables/detail/pellet_points.hpp"

#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr double pi = std::numbers::pi;

Box box_of(const PelletShape& shape) {
    if (!shape.surface_body.empty()) return bounding_box(shape.surface_body);
    Box box;
    for (const Sphere& sphere : shape.rigid.spheres) {
        box.extend(Vec3(sphere.centre.array() - sphere.radius));
        box.extend(Vec3(sphere.centre.array() + sphere.radius));
    }
    return box;
}

/// Winding number of the closed mesh about p as a sum of signed solid angles (Van Oosterom & Strackee 1983, IEEE Trans. Biomed. Eng. 30:125).
double winding_number(const TriangleMesh& mesh, const Vec3& p) {
    double solid_angle = 0.0;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const Vec3 a = mesh.corner(face, 0) - p, b = mesh.corner(face, 1) - p, c = mesh.corner(face, 2) - p;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        const double numerator = a.dot(b.cross(c));
        const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        solid_angle += 2.0 * std::atan2(numerator, denominator);
    }
    return solid_angle / (4.0 * pi);
}

bool is_inside(const PelletShape& shape, const Vec3& p) {
    if (!shape.surface_body.empty()) return winding_number(shape.surface_body, p) > 0.5;
    for (const Sphere& sphere : shape.rigid.spheres)
        if ((p - sphere.centre).squaredNorm() < sphere.radius * sphere.radius) return true;
    return false;
}

/// Points of the additive recurrence on the plastic numbers (Roberts 2018, «R3»: α_k = 1/g^k with g⁴ = g + 1) that fall inside. Unlike a lattice it has no
/// planes that would beat with the measuring grid when pellets lie in rows. Their mean is moved onto the centre of mass, the origin.
std::vector<Vec3> points_inside(const PelletShape& shape, const Box& box, std::size_t candidates) {
    constexpr double g = 1.2207440846057596;
    const Vec3 step(1.0 / g, 1.0 / (g * g), 1.0 / (g * g * g));
    std::vector<Vec3> points;
    Vec3 mean = Vec3::Zero();
    for (std::size_t k = 0; k < candidates; ++k) {
        const Vec3 along = Vec3::Constant(0.5) + static_cast<double>(k + 1) * step;
        const Vec3 unit = along - along.array().floor().matrix();
        const Vec3 p = box.min() + unit.cwiseProduct(box.sizes());
        if (!is_inside(shape, p)) continue;
        points.push_back(p);
        mean += p;
    }
    if (points.empty()) return {Vec3::Zero()};
    mean /= static_cast<double>(points.size());
    for (Vec3& p : points) p -= mean;
    return points;
}

bool axisymmetric_about_z(const Vec3& inertia) {
    const double equal = std::abs(inertia.x() - inertia.y()) / std::max(inertia.x(), inertia.y());
    const double different = std::abs(inertia.z() - 0.5 * (inertia.x() + inertia.y())) / inertia.maxCoeff();
    return equal < 0.01 && different > 0.01;
}

}  // namespace

PelletPoints sample_pellet(const PelletShape& shape, std::size_t wanted) {
    const MassProperties& mass = shape.rigid.mass_properties;
    if (shape.surface_body.empty() && shape.rigid.spheres.empty())
        throw bad_input("the pellet '" + shape.rigid.name + "' has neither a surface nor spheres", "measure a trajectory that PelletLab wrote");
    if (!(mass.volume > 0.0)) throw bad_input("the pellet '" + shape.rigid.name + "' has no volume", "check the mass properties of its template");
    PelletPoints pellet;
    pellet.volume = mass.volume;
    pellet.equivalent_diameter = equivalent_diameter(mass.volume);
    const Box box = box_of(shape);
    pellet.has_axis = axisymmetric_about_z(mass.principal_inertia);
    pellet.half_height = pellet.has_axis ? 0.5 * box.sizes().z() : box.sizes().mean() / 2.0;
    const double candidates = std::ceil(static_cast<double>(wanted) * std::max(1.0, box.volume() / mass.volume));
    if (!(candidates < 1e6)) throw bad_input("the volume of the pellet '" + shape.rigid.name + "' is far too small for its size", "check its unit");
    pellet.points_body = points_inside(shape, box, static_cast<std::size_t>(candidates));
    return pellet;
}

std::vector<PelletPoints> sample_shapes(const TrajectoryHeader& header, std::size_t wanted) {
    std::vector<PelletPoints> shapes;
    for (const PelletShape& shape : header.shapes) shapes.push_back(sample_pellet(shape, wanted));
    return shapes;
}

}  // namespace pelletlab::observables::detail
