#include "solver/detail/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::solver::detail {

namespace {

/// Splits the rotational energy into a symmetric top and one axis: ½ Σ π_k²/I_k = ½ |π|²/I_t + ½ (1/I_a − 1/I_t) π_a² + ½ (1/I_s − 1/I_t) π_s².
void choose_axes(BodyTemplate& t) {
    const Vec3& i = t.inertia;
    int axis = 0;
    double closest = 2.0;
    for (int k = 0; k < 3; ++k) {
        const double a = i[(k + 1) % 3], b = i[(k + 2) % 3];
        const double difference = std::abs(a - b) / std::max(a, b);
        if (difference < closest) closest = difference, axis = k;
    }
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    t.axis = Vec3::Unit(axis);
    t.second_axis = Vec3::Unit(second);
    t.inverse_transverse = 1.0 / i[third];
    t.axial_excess = 1.0 / i[axis] - 1.0 / i[third];
    t.second_excess = closest < 1e-13 ? 0.0 : 1.0 / i[second] - 1.0 / i[third];
}

}  // namespace

BodyTemplate make_body_template(const RigidTemplate& rigid) {
    BodyTemplate t;
    t.balls.reserve(rigid.spheres.size());
    t.smallest_radius = rigid.spheres.front().radius;
    for (const Sphere& s : rigid.spheres) {
        t.balls.push_back({s.centre.x(), s.centre.y(), s.centre.z(), s.radius});
        t.smallest_radius = std::min(t.smallest_radius, s.radius);
        t.largest_offset = std::max(t.largest_offset, s.centre.norm());
    }
    t.bounding_radius = bounding_radius(rigid.spheres);
    const MassProperties& m = rigid.mass_properties;
    t.mass = m.mass;
    t.inverse_mass = 1.0 / m.mass;
    t.inertia = m.principal_inertia;
    t.inverse_inertia = t.inertia.cwiseInverse();
    t.smallest_inertia = t.inertia.minCoeff();
    t.density = m.density > 0.0 ? m.density : (m.volume > 0.0 ? m.mass / m.volume : 0.0);
    choose_axes(t);
    return t;
}

void Bodies::resize(std::size_t n) {
    template_index.resize(n, 0);
    each_array([n](std::vector<double>& a) { a.resize(n, 0.0); });
}

}  // namespace pelletlab::solver::detail
