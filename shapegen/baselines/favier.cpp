#include <algorithm>
#include <limits>

#include "meshes/mass_properties.hpp"
#include "shapegen/baselines/baselines.hpp"

namespace pelletlab::shapegen::baselines {

std::vector<Sphere> favier(const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings) {
    const MassProperties mass = meshes::mass_properties(body, 1.0);
    Eigen::Index slender = 0;  // the axis of the least moment is the long one
    mass.principal_inertia.minCoeff(&slender);
    const Vec3 axis = mass.principal_axes * Vec3::Unit(slender);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& v : body.vertices) {
        low = std::min(low, axis.dot(v - mass.centre_of_mass_mesh));
        high = std::max(high, axis.dot(v - mass.centre_of_mass_mesh));
    }
    std::vector<Sphere> spheres;
    for (std::uint32_t k = 0; k < settings.sphere_count; ++k) {
        const double at = low + (high - low) * (k + 0.5) / settings.sphere_count;
        const Vec3 centre = mass.centre_of_mass_mesh + at * axis;
        const double depth = -exact.value(centre);
        if (depth > 0.0) spheres.push_back({centre, depth});
    }
    return spheres;
}

}  // namespace pelletlab::shapegen::baselines
