#include "meshes/signed_distance.hpp"

#include "core/parallel.hpp"

namespace pelletlab::meshes {

std::vector<double> SignedDistance::values(std::span<const Vec3> points) const {
    std::vector<double> result(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) { result[i] = value(points[i]); });
    return result;
}

}  // namespace pelletlab::meshes
