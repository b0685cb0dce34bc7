#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.hpp"
#include "meshes/check.hpp"
#include "meshes/detail/clean.hpp"
#include "meshes/detail/shells.hpp"
#include "meshes/detail/topology.hpp"
#include "meshes/detail/weld.hpp"

namespace pelletlab::meshes {
namespace {

constexpr double largest_extent = 1.0;    // [m]
constexpr double smallest_extent = 1e-6;  // [m]
constexpr double flatness = 1e-9;         // volume / (area · extent), and thickness / extent, below which a body counts as flat

std::string in_mm(const Vec3& p) {
    std::ostringstream text;
    text.precision(6);
    text << '(' << p.x() * 1e3 << ", " << p.y() * 1e3 << ", " << p.z() * 1e3 << ") mm";
    return text.str();
}

std::string length_text(double metres) {
    std::ostringstream text;
    text.precision(4);
    if (metres >= 1.0)
        text << metres << " m";
    else if (metres >= 1e-3)
        text << metres * 1e3 << " mm";
    else
        text << metres * 1e6 << " um";
    return text.str();
}

std::string count_text(std::size_t count, const char* singular, const char* plural) {
    return std::to_string(count) + ' ' + (count == 1 ? singular : plural);
}

void require_size(const MeshReport& report) {
    const double extent = report.extent.maxCoeff();
    if (extent > largest_extent)
        throw bad_input("the body is " + length_text(extent) + " large; a pellet is at most 1 m",
                        "was the unit of the mesh file forgotten? For instance --unit mm, or mesh_unit = \"mm\" in a case");
    if (extent < smallest_extent)
        throw bad_input("the body is only " + length_text(extent) + " large; a pellet is at least 1 um",
                        "check the unit of the mesh file, for instance --unit mm, or mesh_unit = \"mm\" in a case");
}

/// Turns outer shells outward and cavities inward; returns how many shells were turned.
std::size_t orient_shells(TriangleMesh& mesh) {
    const detail::Shells shells = detail::find_shells(mesh, detail::sorted_half_edges(mesh));
    const std::vector<detail::ShellPlace> places = detail::nesting(mesh, shells);
    std::vector<bool> turn(shells.count, false);
    std::size_t count = 0;
    for (std::size_t s = 0; s < shells.count; ++s) {
        turn[s] = (places[s].volume < 0.0) == (places[s].depth % 2 == 0);
        count += turn[s];
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (turn[shells.of_face[f]]) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    return count;
}

[[noreturn]] void refuse(const MeshDefect& defect) {
    const std::string place = ", the first near " + in_mm(defect.place);
    const std::string number = std::to_string(defect.count) + ' ';
    const std::string remedy = "repair it in the program that made it, or ask for the repair of open and self-intersecting meshes";
    if (defect.what == "boundary edges") throw bad_input("the surface is not closed: " + number + "edges have a triangle on one side only" + place, remedy);
    if (defect.what == "self-intersecting pairs of triangles")
        throw bad_input("the surface crosses itself: " + number + "pairs of triangles intersect" + place, remedy);
    if (defect.what == "separate bodies")
        throw bad_input("the file holds " + number + "separate bodies, but a pellet is one" + place, "keep one body in the file");
    throw bad_input("the mesh is not the surface of one body: " + number + defect.what + place, remedy);
}

}  // namespace

CheckedMesh require_closed_body(const TriangleMesh& mesh) {
    CheckedMesh result{mesh, check(mesh), {}};
    require_size(result.before);
    TriangleMesh& repaired = result.mesh;
    std::vector<std::string> repairs;
    const auto note = [&](std::size_t count, const char* singular, const char* plural, const char* deed) {
        if (count > 0) repairs.push_back(count_text(count, singular, plural) + ' ' + deed);
    };

    repaired = detail::weld(repaired);
    note(mesh.vertices.size() - repaired.vertices.size(), "vertex", "vertices", "joined with an equal one or dropped as unused");
    const std::size_t repeated = detail::drop_repeated_corners(repaired);
    note(detail::drop_duplicates(repaired), "duplicate triangle", "duplicate triangles", "dropped");
    if (repaired.empty()) throw bad_input("the mesh has no triangle with an area", "export the body again");
    note(detail::orient_consistently(repaired), "triangle", "triangles", "turned to agree with its neighbours");
    note(repeated + detail::remove_degenerate(repaired), "triangle without area", "triangles without area", "removed");
    if (repaired.empty()) throw bad_input("the mesh has no triangle with an area", "export the body again");
    repaired = detail::weld(repaired);  // drops what the removals left unused

    MeshReport report = check(repaired);
    const bool is_flat = report.extent.minCoeff() <= flatness * report.extent.maxCoeff();
    const bool is_closed = report.boundary_edges + report.non_manifold_edges + report.inconsistent_edges == 0;
    if (is_flat || (is_closed && std::abs(report.volume) <= flatness * report.area * report.extent.maxCoeff()))
        throw bad_input("the body has no volume: it is flat, near " + in_mm(bounding_box(repaired).center()), "export a solid body, not a sheet");
    if (is_closed && report.self_intersections == 0) {
        const std::size_t turned = orient_shells(repaired);
        if (turned > 0) {
            if (report.shells == 1)
                repairs.emplace_back("the mesh was inside-out: all triangles turned");
            else
                note(turned, "shell", "shells", "turned: bodies outward, cavities inward");
            report = check(repaired);
        }
    }
    if (!report.defects.empty()) refuse(report.defects.front());
    result.report = report;
    result.report.repairs = std::move(repairs);
    return result;
}

}  // namespace pelletlab::meshes
