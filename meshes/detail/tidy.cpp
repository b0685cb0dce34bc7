#include "meshes/detail/tidy.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.hpp"
#include "meshes/detail/clean.hpp"
#include "meshes/detail/shells.hpp"
#include "meshes/detail/topology.hpp"
#include "meshes/detail/weld.hpp"

namespace pelletlab::meshes::detail {
namespace {

constexpr double largest_extent = 1.0;    // [m]
constexpr double smallest_extent = 1e-6;  // [m]
constexpr double flatness = 1e-9;         // volume / (area · extent), and thickness / extent, below which a body counts as flat

}  // namespace

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
    else if (metres >= 1e-10 || metres == 0.0)
        text << metres * 1e6 << " um";
    else
        text << "less than 0.0001 um";
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

void require_thickness(const MeshReport& report, const TriangleMesh& mesh) {
    const bool is_flat = report.extent.minCoeff() <= flatness * report.extent.maxCoeff();
    const bool is_closed = report.boundary_edges + report.non_manifold_edges + report.inconsistent_edges == 0;
    // Several shells may cancel each other's volume before they are turned the right way.
    if (is_flat || (is_closed && report.shells == 1 && std::abs(report.volume) <= flatness * report.area * report.extent.maxCoeff()))
        throw bad_input("the body has no volume: it is flat, near " + in_mm(bounding_box(mesh).center()), "export a solid body, not a sheet");
}

TriangleMesh tidied(const TriangleMesh& mesh, std::vector<std::string>& repairs) {
    const auto note = [&](std::size_t count, const char* singular, const char* plural, const char* deed) {
        if (count > 0) repairs.push_back(count_text(count, singular, plural) + ' ' + deed);
    };
    TriangleMesh result = weld(mesh);
    note(mesh.vertices.size() - result.vertices.size(), "vertex", "vertices", "joined with an equal one or dropped as unused");
    const std::size_t repeated = drop_repeated_corners(result);
    note(drop_duplicates(result), "duplicate triangle", "duplicate triangles", "dropped");
    note(orient_consistently(result), "triangle", "triangles", "turned to agree with its neighbours");
    note(repeated + remove_degenerate(result), "triangle without area", "triangles without area", "removed");
    if (result.empty()) throw bad_input("the mesh has no triangle with an area", "export the body again");
    return weld(result);  // drops the vertices that the removals left unused
}

void orient_shells(TriangleMesh& mesh, std::vector<std::string>& repairs) {
    const Shells shells = find_shells(mesh, sorted_half_edges(mesh));
    const std::vector<ShellPlace> places = nesting(mesh, shells);
    std::vector<bool> turn(shells.count, false);
    std::size_t turned = 0;
    for (std::size_t s = 0; s < shells.count; ++s) {
        turn[s] = (places[s].volume < 0.0) == (places[s].depth % 2 == 0);
        turned += turn[s];
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (turn[shells.of_face[f]]) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    if (turned > 0 && shells.count == 1) repairs.emplace_back("the mesh was inside-out: all triangles turned");
    if (turned > 0 && shells.count > 1) repairs.push_back(count_text(turned, "shell", "shells") + " turned: bodies outward, cavities inward");
}

void refuse(const MeshDefect& defect) {
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

}  // namespace pelletlab::meshes::detail
