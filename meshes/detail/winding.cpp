#include "meshes/detail/winding.hpp"

#include <cmath>
#include <numbers>

namespace pelletlab::meshes::detail {

double solid_angle_fraction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = a - p, v = b - p, w = c - p;
    const double lu = u.norm(), lv = v.norm(), lw = w.norm();
    const double numerator = u.dot(v.cross(w));
    const double denominator = lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv;
    return std::atan2(numerator, denominator) / (2.0 * std::numbers::pi);
}

}  // namespace pelletlab::meshes::detail
