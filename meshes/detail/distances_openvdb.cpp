#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <limits>

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

std::vector<float> openvdb_distances(const TriangleMesh& mesh, const Block& block, double farthest) {
    openvdb::initialize();
    const auto transform = openvdb::math::Transform::createLinearTransform(block.voxel);
    // The outer band reaches the farthest point of the block, the inner one fills the body: no point is left with the background value.
    const auto exterior = static_cast<float>(farthest / block.voxel + 1.0);
    const openvdb::FloatGrid::Ptr grid =
        openvdb::tools::meshToVolume<openvdb::FloatGrid>(IndexSpaceMesh{mesh, block}, *transform, exterior, std::numeric_limits<float>::max());
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
