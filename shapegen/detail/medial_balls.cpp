#include "shapegen/detail/medial_balls.hpp"

#include <algorithm>

namespace pelletlab::shapegen::detail {

double medial_radius(const meshes::SignedDistance& distance, const Vec3& p, const Vec3& n, double largest, double tolerance) {
    double radius = largest;
    for (int k = 0; k < 40; ++k) {
        const Vec3 c = p - radius * n;
        const meshes::DistanceSample at = distance.sample(c);
        const double depth = -at.value;
        if (depth >= radius - tolerance) return radius;
        if (depth <= 0.0) {  // the centre is outside: far too large
            radius *= 0.5;
            continue;
        }
        // q: the surface point nearest to the centre. The ball through p (tangent) and q is the next guess.
        const Vec3 to_q = p - (c + depth * at.gradient);
        const double across = 2.0 * n.dot(to_q);
        const double next = across > 0.0 ? to_q.squaredNorm() / across : 0.5 * radius;
        radius = std::clamp(next, 0.3 * radius, radius - 0.25 * tolerance);
    }
    return radius;
}

}  // namespace pelletlab::shapegen::detail
