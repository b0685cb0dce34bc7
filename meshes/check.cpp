#include "meshes/check.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "meshes/detail/clean.hpp"
#include "meshes/detail/self_intersections.hpp"
#include "meshes/detail/shells.hpp"
#include "meshes/detail/topology.hpp"
#include "meshes/mass_properties.hpp"

namespace pelletlab::meshes {
namespace {

void require_usable(const TriangleMesh& mesh) {
    if (mesh.empty()) throw bad_input("the mesh has no triangles", "export the body as a triangulated surface");
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (const std::uint32_t vertex : mesh.faces[f]) {
            if (vertex >= mesh.vertices.size())
                throw bad_input("triangle " + std::to_string(f + 1) + " names vertex " + std::to_string(vertex + 1) + ", but there are only " +
                                    std::to_string(mesh.vertices.size()),
                                "export the mesh again");
            if (!mesh.vertices[vertex].allFinite())
                throw bad_input("triangle " + std::to_string(f + 1) + " has a coordinate that is not a finite number", "export the mesh again");
        }
}

/// Counts one kind of defect and remembers where the first one is.
struct Counter {
    std::size_t count = 0;
    Vec3 place = Vec3::Zero();
    void add(const Vec3& where) {
        if (count++ == 0) place = where;
    }
};

Vec3 middle(const TriangleMesh& mesh, std::size_t face) {
    return (mesh.corner(face, 0) + mesh.corner(face, 1) + mesh.corner(face, 2)) / 3.0;
}

}  // namespace

MeshReport check(const TriangleMesh& mesh) {
    require_usable(mesh);
    MeshReport report;
    report.vertices = mesh.vertices.size();
    report.faces = mesh.faces.size();
    Box box;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (int k = 0; k < 3; ++k) box.extend(mesh.corner(f, k));
        report.area += 0.5 * (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0)).norm();
    }
    report.extent = box.sizes();
    report.volume = volume_moments(mesh).volume;
    report.inside_out = report.volume < 0.0;

    Counter boundary, non_manifold, inconsistent, pinched, degenerate, duplicate, crossing;
    const std::vector<detail::HalfEdge> half_edges = detail::sorted_half_edges(mesh);
    detail::for_each_edge(half_edges, [&](const detail::HalfEdge* begin, const detail::HalfEdge* end) {
        const Vec3 where = 0.5 * (mesh.vertices[begin->low] + mesh.vertices[begin->high]);
        if (end - begin == 1) boundary.add(where);
        if (end - begin == 2 && begin[0].forward == begin[1].forward) inconsistent.add(where);
        if (end - begin > 2) non_manifold.add(where);
    });
    for (const std::uint32_t vertex : detail::pinched_vertices(mesh, half_edges)) pinched.add(mesh.vertices[vertex]);
    std::set<Triangle> seen;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        Triangle key = mesh.faces[f];
        std::sort(key.begin(), key.end());
        if (detail::is_degenerate(mesh, mesh.faces[f])) degenerate.add(middle(mesh, f));
        if (!seen.insert(key).second) duplicate.add(middle(mesh, f));
    }
    for (const auto& [f, g] : detail::self_intersections(mesh)) crossing.add(0.5 * (middle(mesh, f) + middle(mesh, g)));
    report.boundary_edges = boundary.count;
    report.non_manifold_edges = non_manifold.count;
    report.inconsistent_edges = inconsistent.count;
    report.pinched_vertices = pinched.count;
    report.degenerate_faces = degenerate.count;
    report.duplicate_faces = duplicate.count;
    report.self_intersections = crossing.count;

    const detail::Shells shells = detail::find_shells(mesh, half_edges);
    report.shells = shells.count;
    report.separate_bodies = shells.count;
    const bool can_nest = boundary.count + non_manifold.count + inconsistent.count + crossing.count == 0;
    Counter bodies, wrongly_turned;
    if (can_nest) {
        for (const detail::ShellPlace& shell : detail::nesting(mesh, shells)) {
            if (shell.depth % 2 == 0) bodies.add(shell.point);
            if ((shell.volume < 0.0) == (shell.depth % 2 == 0)) wrongly_turned.add(shell.point);
        }
        report.separate_bodies = bodies.count;
    }

    const auto note = [&](const char* what, const Counter& counter) {
        if (counter.count > 0) report.defects.push_back({what, counter.count, counter.place});
    };
    note("boundary edges", boundary);
    note("edges shared by more than two triangles", non_manifold);
    note("self-intersecting pairs of triangles", crossing);
    note("vertices where the surface touches itself", pinched);
    note("edges where neighbours disagree about inside and outside", inconsistent);
    note("triangles without area", degenerate);
    note("duplicate triangles", duplicate);
    note("shells that are inside-out", wrongly_turned);
    if (report.separate_bodies > 1 && can_nest) report.defects.push_back({"separate bodies", bodies.count, bodies.place});
    if (report.volume == 0.0) report.defects.push_back({"zero volume", 1, box.center()});
    return report;
}

bool MeshReport::is_closed_body() const {
    return faces > 0 && defects.empty() && volume > 0.0;
}

std::string MeshReport::summary() const {
    std::ostringstream text;
    text.precision(6);
    text << faces << " triangles, " << vertices << " vertices, " << shells << (shells == 1 ? " shell" : " shells") << '\n';
    text << "extent " << extent.x() * 1e3 << " x " << extent.y() * 1e3 << " x " << extent.z() * 1e3 << " mm, area " << area * 1e6 << " mm^2, volume "
         << volume * 1e9 << " mm^3\n";
    if (is_closed_body()) text << "closed, oriented outward, free of self-intersections\n";
    for (const MeshDefect& defect : defects)
        text << defect.count << ' ' << defect.what << ", at (" << defect.place.x() * 1e3 << ", " << defect.place.y() * 1e3 << ", " << defect.place.z() * 1e3
             << ") mm\n";
    for (const std::string& repair : repairs) text << "repaired: " << repair << '\n';
    return text.str();
}

}  // namespace pelletlab::meshes
