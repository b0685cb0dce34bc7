// A triangle mesh as plain data. How to read, check, repair and measure one is the business of meshes/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab {

using Triangle = std::array<std::uint32_t, 3>;  ///< vertex indices, counter-clockwise seen from outside

struct TriangleMesh {
    std::vector<Vec3> vertices;  ///< [m]
    std::vector<Triangle> faces;

    Vec3 corner(std::size_t face, int k) const { return vertices[faces[face][static_cast<std::size_t>(k)]]; }
    bool empty() const { return faces.empty(); }
};

inline Box bounding_box(const TriangleMesh& mesh) {
    Box box;
    for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
    return box;
}

/// The mesh moved rigidly: every vertex v becomes pose.to_world(v).
inline TriangleMesh transformed(TriangleMesh mesh, const Pose& pose) {
    for (Vec3& vertex : mesh.vertices) vertex = pose.to_world(vertex);
    return mesh;
}

}  // namespace pelletlab
