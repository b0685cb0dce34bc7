#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "shapegen/baselines/baselines.hpp"

namespace pelletlab::shapegen::baselines {

std::vector<Sphere> euclidean_map(const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings) {
    const Box box = bounding_box(body);
    const double cell = settings.cell_fraction * box.sizes().minCoeff();
    const auto count = [&](int k) { return static_cast<std::size_t>(std::ceil(box.sizes()[k] / cell)); };
    const std::size_t nx = count(0), ny = count(1), nz = count(2);
    const auto middle = [&](std::size_t i) {
        const std::size_t x = i / (ny * nz), y = i / nz % ny, z = i % nz;
        return Vec3(box.min() + cell * Vec3(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, static_cast<double>(z) + 0.5));
    };
    // Radius of the largest sphere around each cell's middle that fits into the body, and later beside the cores.
    std::vector<double> room(nx * ny * nz);
    parallel_for(room.size(), 512, [&](std::size_t i) { room[i] = -exact.value(middle(i)); });
    std::vector<Sphere> spheres;
    while (spheres.size() < settings.sphere_count) {
        const auto most = static_cast<std::size_t>(std::max_element(room.begin(), room.end()) - room.begin());
        if (room[most] <= 0.5 * cell) break;
        const Sphere sphere{middle(most), room[most]};
        spheres.push_back(sphere);
        const double core = (1.0 - settings.overlap) * sphere.radius;
        parallel_for(room.size(), 8192, [&](std::size_t i) { room[i] = std::min(room[i], (middle(i) - sphere.centre).norm() - core); });
    }
    return spheres;
}

}  // namespace pelletlab::shapegen::baselines
