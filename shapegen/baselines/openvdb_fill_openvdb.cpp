#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToSpheres.h>

#include <limits>

#include "shapegen/baselines/baselines.hpp"

namespace pelletlab::shapegen::baselines {

std::vector<Sphere> openvdb_fill(const TriangleMesh& body, const BaselineSettings& settings) {
    openvdb::initialize();
    // In cells, so that the narrow band and OpenVDB's tolerances see numbers of order one.
    const double cell = settings.cell_fraction * bounding_box(body).sizes().minCoeff();
    std::vector<openvdb::Vec3s> points;
    for (const Vec3& v : body.vertices) {
        points.emplace_back(static_cast<float>(v.x() / cell), static_cast<float>(v.y() / cell), static_cast<float>(v.z() / cell));
    }
    std::vector<openvdb::Vec3I> triangles;
    for (const Triangle& t : body.faces) triangles.emplace_back(t[0], t[1], t[2]);
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    const auto grid = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles, 4.0f);
    std::vector<openvdb::Vec4s> found;
    const auto most = static_cast<int>(settings.sphere_count);
    openvdb::tools::fillWithSpheres(*grid, found, openvdb::Vec2i(most, most), true, 1.0f, std::numeric_limits<float>::max(), 0.0f, 100000);
    std::vector<Sphere> spheres;
    for (const openvdb::Vec4s& s : found) {
        if (s[3] > 0.0f) spheres.push_back({Vec3(s[0], s[1], s[2]) * cell, s[3] * cell});
    }
    return spheres;
}

}  // namespace pelletlab::shapegen::baselines
