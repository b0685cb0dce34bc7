#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>

#include "meshes/detail/cgal_mesh.hpp"
#include "meshes/detail/surgery.hpp"
#include "meshes/detail/topology.hpp"
#include "meshes/detail/weld.hpp"
#include "meshes/mass_properties.hpp"

namespace pelletlab::meshes::detail {
namespace {

using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

}  // namespace

std::optional<TriangleMesh> unite_shells(const TriangleMesh& mesh) {
    const Shells shells = find_shells(mesh, sorted_half_edges(mesh));
    std::optional<Surface> sum;
    for (std::uint32_t shell = 0; shell < shells.count; ++shell) {
        TriangleMesh part;
        part.vertices = mesh.vertices;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f)
            if (shells.of_face[f] == shell) part.faces.push_back(mesh.faces[f]);
        part = weld(part);
        if (volume_moments(part).volume < 0.0)
            for (Triangle& t : part.faces) std::swap(t[1], t[2]);
        Surface surface;
        if (!to_cgal(part, surface) || !CGAL::is_closed(surface)) return std::nullopt;
        if (!sum) {
            sum = std::move(surface);
            continue;
        }
        Surface joined;
        try {
            namespace PMP = CGAL::Polygon_mesh_processing;
            if (!PMP::corefine_and_compute_union(*sum, surface, joined, CGAL::parameters::throw_on_self_intersection(true))) return std::nullopt;
        } catch (const CGAL::Polygon_mesh_processing::Corefinement::Self_intersection_exception&) {
            return std::nullopt;
        }
        sum = std::move(joined);
    }
    if (!sum) return std::nullopt;
    return from_cgal(*sum);
}

}  // namespace pelletlab::meshes::detail
