// Which faces of a wall come near a ball: bounding-volume search by Embree, then the exact distance in double precision.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "solver/detail/wall_mesh.hpp"

namespace pelletlab::solver::detail {

class WallQuery {
public:
    explicit WallQuery(const WallMesh& mesh);
    ~WallQuery();
    WallQuery(WallQuery&&) noexcept;
    WallQuery& operator=(WallQuery&&) noexcept;

    /// Faces within `radius` of `centre` [m, frame of the wall], ascending. Safe to call from several threads.
    void faces_near(const WallMesh& mesh, const Vec3& centre, double radius, std::vector<std::uint32_t>& faces) const;

private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

}  // namespace pelletlab::solver::detail
