#include "meshes/check.hpp"
#include "meshes/detail/tidy.hpp"

namespace pelletlab::meshes {

CheckedMesh require_closed_body(const TriangleMesh& mesh) {
    CheckedMesh result{mesh, check(mesh), {}};
    detail::require_size(result.before);
    std::vector<std::string> repairs;
    if (!result.before.is_closed_body()) {
        result.mesh = detail::tidied(mesh, repairs);
        MeshReport report = check(result.mesh);
        detail::require_thickness(report, result.mesh);
        if (report.boundary_edges + report.non_manifold_edges + report.inconsistent_edges + report.self_intersections == 0)
            detail::orient_shells(result.mesh, repairs);
    }
    result.report = repairs.empty() && result.before.is_closed_body() ? result.before : check(result.mesh);
    detail::require_thickness(result.report, result.mesh);
    if (!result.report.defects.empty()) detail::refuse(result.report.defects.front());
    result.report.repairs = std::move(repairs);
    return result;
}

}  // namespace pelletlab::meshes
