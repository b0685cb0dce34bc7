#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include "core/parallel.hpp"
#include "meshes/detail/openvdb_distances.hpp"

namespace pelletlab::meshes::detail {
namespace {

/// The mesh in voxel units relative to the first point of the block, as OpenVDB's reader wants it.
struct IndexSpaceMesh {
    const TriangleMesh& mesh;
    const Block& block;
    std::size_t polygonCount() const { return mesh.faces.size(); }
    std::size_t pointCount() const { return mesh.vertices.size(); }
    std::size_t vertexCount(std::size_t) const { return 3; }
    void getIndexSpacePoint(std::size_t face, std::size_t corner, openvdb::Vec3d& p) const {
        const Vec3 v = (mesh.corner(face, static_cast<int>(corner)) - block.origin) / block.voxel;
        p = openvdb::Vec3d(v.x(), v.y(), v.z());
    }
};

}  // namespace

std::vector<float> openvdb_distances(const TriangleMesh& mesh, const Block& block, double band_voxels) {
    openvdb::initialize();
    const auto transform = openvdb::math::Transform::createLinearTransform(block.voxel);
    // Renormalisation would smooth the distances of a clean mesh, too, by 0.15 voxels.
    const auto band = static_cast<float>(band_voxels);
    const openvdb::FloatGrid::Ptr grid =
        openvdb::tools::meshToVolume<openvdb::FloatGrid>(IndexSpaceMesh{mesh, block}, *transform, band, band, openvdb::tools::DISABLE_RENORMALIZATION);
    const std::size_t nx = block.count[0], ny = block.count[1], nz = block.count[2];
    std::vector<float> distances(nx * ny * nz);
    parallel_for(nz, 1, [&](std::size_t k) {
        const openvdb::FloatGrid::ConstAccessor accessor = grid->getConstAccessor();
        float* out = distances.data() + k * nx * ny;
        for (std::size_t j = 0; j < ny; ++j)
            for (std::size_t i = 0; i < nx; ++i) *out++ = accessor.getValue({static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)});
    });
    return distances;
}

}  // namespace pelletlab::meshes::detail
