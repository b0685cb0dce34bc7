#include "shapegen/sum_properties.hpp"

#include <numbers>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"

namespace pelletlab::shapegen {

MassProperties sum_mass_properties(std::span<const Sphere> spheres, double density) {
    if (spheres.empty()) throw bad_input("there are no spheres to weigh", "give at least one");
    if (!(density > 0.0)) throw bad_input("the particle density is not positive", "give it like 1800 kg/m^3");
    const auto volume = [](const Sphere& s) { return 4.0 / 3.0 * std::numbers::pi * s.radius * s.radius * s.radius; };
    MassProperties sum;
    sum.density = density;
    Vec3 first = Vec3::Zero();
    for (const Sphere& s : spheres) {
        sum.volume += volume(s);
        first += volume(s) * s.centre;
    }
    sum.mass = density * sum.volume;
    sum.centre_of_mass_mesh = first / sum.volume;
    Mat3 inertia = Mat3::Zero();
    for (const Sphere& s : spheres) {
        const Vec3 d = s.centre - sum.centre_of_mass_mesh;
        inertia += density * volume(s) * ((0.4 * s.radius * s.radius + d.squaredNorm()) * Mat3::Identity() - d * d.transpose());
    }
    const meshes::PrincipalFrame frame = meshes::principal_frame(inertia);
    sum.principal_axes = frame.axes;
    sum.principal_inertia = frame.moments;
    return sum;
}

}  // namespace pelletlab::shapegen
