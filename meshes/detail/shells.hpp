// Which shell of a mesh lies inside which: a body and its cavities.
#pragma once

#include <vector>

#include "meshes/detail/topology.hpp"

namespace pelletlab::meshes::detail {

struct ShellPlace {
    Vec3 point = Vec3::Zero();  ///< [m], a corner of the shell
    double volume = 0.0;        ///< [m³], signed, of this shell alone
    std::uint32_t depth = 0;    ///< number of other shells around it: 0 a body, 1 a cavity, 2 a body inside a cavity
};

/// Place of each shell. The shells must be closed, consistently oriented and must not cross.
std::vector<ShellPlace> nesting(const TriangleMesh& mesh, const Shells& shells);

}  // namespace pelletlab::meshes::detail
