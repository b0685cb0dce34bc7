#include "meshes/detail/shells.hpp"

#include <cmath>

#include "meshes/detail/winding.hpp"
#include "meshes/mass_properties.hpp"

namespace pelletlab::meshes::detail {

std::vector<ShellPlace> nesting(const TriangleMesh& mesh, const Shells& shells) {
    std::vector<ShellPlace> places(shells.count);
    std::vector<TriangleMesh> parts(shells.count);
    std::vector<Box> boxes(shells.count);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const std::uint32_t shell = shells.of_face[f];
        if (shell == shells.count) continue;
        if (parts[shell].empty()) places[shell].point = mesh.corner(f, 0);
        const auto first = static_cast<std::uint32_t>(parts[shell].vertices.size());
        for (int k = 0; k < 3; ++k) {
            parts[shell].vertices.push_back(mesh.corner(f, k));
            boxes[shell].extend(mesh.corner(f, k));
        }
        parts[shell].faces.push_back({first, first + 1, first + 2});
    }
    for (std::uint32_t i = 0; i < shells.count; ++i) {
        places[i].volume = volume_moments(parts[i]).volume;
        for (std::uint32_t j = 0; j < shells.count; ++j) {
            if (i == j || !boxes[j].contains(places[i].point)) continue;
            const double winding = winding_number(parts[j], places[i].point, [](std::size_t) { return true; });
            if (std::abs(winding) > 0.5) ++places[i].depth;
        }
    }
    return places;
}

}  // namespace pelletlab::meshes::detail
