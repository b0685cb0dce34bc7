#include "meshes/repair.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "meshes/detail/surgery.hpp"
#include "meshes/detail/tidy.hpp"
#include "meshes/detail/triangle_tree.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::meshes {
namespace {

using Lines = std::vector<std::string>;

constexpr double default_alpha_share = 1.0 / 30.0;    // of the diagonal: a wrap of some ten thousand triangles
constexpr double default_offset_share = 1.0 / 900.0;  // of the diagonal
constexpr double most_thin_share = 0.1;               // of a wrap's area
constexpr double most_wrap_triangles = 2e6;

/// The wrap's vertices drawn in to the given surface where it is near; as far as the wrap stays a closed body.
TriangleMesh drawn_in(const TriangleMesh& wrap, const detail::TriangleTree& given, double offset) {
    for (const double share : {1.0, 0.5}) {
        TriangleMesh closer = wrap;
        for (Vec3& v : closer.vertices) {
            const detail::NearestPoint nearest = given.nearest(v);
            if (nearest.squared_distance <= 4.0 * offset * offset) v += share * (nearest.point - v);  // else it bridges a hole
        }
        if (check(closer).is_closed_body()) return closer;
    }
    return wrap;
}

/// True when the wrap went through a hole and covers both sides of the surface: three offsets below a good part of it one is outside again.
bool is_a_coated_sheet(const TriangleMesh& wrap, double offset) {
    const std::unique_ptr<SignedDistance> distance = exact_signed_distance(wrap);
    double thick = 0.0, thin = 0.0;
    for (std::size_t f = 0; f < wrap.faces.size(); ++f) {
        const Vec3 a = wrap.corner(f, 0), normal = (wrap.corner(f, 1) - a).cross(wrap.corner(f, 2) - a);
        const double twice_area = normal.norm();
        const Vec3 below = (a + wrap.corner(f, 1) + wrap.corner(f, 2)) / 3.0 - normal * (3.0 * offset / twice_area);
        (distance->value(below) < 0.0 ? thick : thin) += twice_area;
    }
    return thin > most_thin_share * (thin + thick);
}

TriangleMesh wrapped(const TriangleMesh& mesh, const RepairSettings& settings, const MeshReport& report, Lines& lines) {
    const double diagonal = report.extent.norm();
    double alpha = settings.alpha;
    if (alpha == 0.0) {
        const double hole_radius = detail::fill_holes(mesh).largest_perimeter / (2.0 * std::numbers::pi);
        alpha = std::max(default_alpha_share * diagonal, 1.1 * hole_radius);
    }
    if (!(alpha > 0.0) || !(settings.offset >= 0.0) || !std::isfinite(alpha + settings.offset))
        throw bad_input("the alpha and the offset of a wrap must be positive lengths", "leave them at 0 to have them chosen");
    if (report.area / (alpha * alpha) > most_wrap_triangles)
        throw bad_input("a wrap with alpha = " + detail::length_text(alpha) + " would need more than two million triangles", "choose a larger alpha");
    // A wrap that slips in through a hole needs a larger alpha; the user's own is not changed.
    const double offset = settings.offset != 0.0 ? settings.offset : default_offset_share * diagonal;
    TriangleMesh wrap;
    while (true) {
        wrap = detail::alpha_wrap(mesh, alpha, offset);
        if (!is_a_coated_sheet(wrap, offset)) break;
        alpha *= 1.5;
        if (settings.alpha != 0.0 || alpha > 0.5 * diagonal)
            throw bad_input("the surface is too open for a wrap, near " + detail::in_mm(bounding_box(mesh).center()) + ": it would be coated on both sides",
                            "export a solid body, or choose an alpha larger than its holes");
    }
    const detail::TriangleTree given(mesh);
    const TriangleMesh result = drawn_in(wrap, given, offset);
    double farthest = 0.0, sum = 0.0;
    for (const Vec3& v : result.vertices) {
        const double distance = std::sqrt(given.squared_distance(v));
        farthest = std::max(farthest, distance);
        sum += distance;
    }
    lines.push_back("wrapped from outside with alpha " + detail::length_text(alpha) + " and offset " + detail::length_text(offset) + ": " +
                    std::to_string(result.faces.size()) + " triangles whose corners lie on average " +
                    detail::length_text(sum / static_cast<double>(result.vertices.size())) + " and at most " + detail::length_text(farthest) +
                    " from the given surface; cavities are gone");
    return result;
}

TriangleMesh filled(const TriangleMesh& mesh, Lines& lines) {
    const detail::FilledMesh result = detail::fill_holes(mesh);
    if (result.holes > 0)
        lines.push_back(detail::count_text(result.holes, "hole", "holes") + " closed with a patch, the longest rim " +
                        detail::length_text(result.largest_perimeter));
    return result.mesh;
}

std::optional<TriangleMesh> united(const TriangleMesh& mesh, std::size_t shells, Lines& lines) {
    std::optional<TriangleMesh> result = detail::unite_shells(mesh);
    if (result) lines.push_back(std::to_string(shells) + " shells united into one body");
    return result;
}

/// The closed body that a step led to, with the lines of that step; nothing when the step did not lead to one.
std::optional<CheckedMesh> accepted(const TriangleMesh& mesh, const Lines& lines) {
    try {
        CheckedMesh checked = require_closed_body(mesh);
        checked.report.repairs.insert(checked.report.repairs.begin(), lines.begin(), lines.end());
        return checked;
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Patches and unions as far as they are called for.
std::optional<CheckedMesh> gently_repaired(TriangleMesh mesh, Lines lines) {
    MeshReport report = check(mesh);
    if (report.non_manifold_edges > 0) return std::nullopt;
    if (report.boundary_edges > 0) {
        mesh = filled(mesh, lines);
        if (std::optional<CheckedMesh> done = accepted(mesh, lines)) return done;
        report = check(mesh);
    }
    if (report.boundary_edges + report.non_manifold_edges > 0 || report.shells < 2) return std::nullopt;
    const std::optional<TriangleMesh> one = united(mesh, report.shells, lines);
    return one ? accepted(*one, lines) : std::nullopt;
}

}  // namespace

CheckedMesh repair_to_closed_body(const TriangleMesh& mesh, const RepairSettings& settings) {
    const MeshReport before = check(mesh);
    detail::require_size(before);
    if (settings.method == RepairMethod::automatic)
        if (std::optional<CheckedMesh> fine = accepted(mesh, {})) return *fine;

    Lines lines;
    const TriangleMesh tidy = detail::tidied(mesh, lines);
    const MeshReport report = check(tidy);
    detail::require_thickness(report, tidy);
    CheckedMesh result;
    switch (settings.method) {
        case RepairMethod::automatic: {
            if (std::optional<CheckedMesh> done = gently_repaired(tidy, lines)) {
                result = *done;
                break;
            }
            [[fallthrough]];
        }
        case RepairMethod::alpha_wrap: {
            const TriangleMesh wrap = wrapped(tidy, settings, report, lines);
            result = require_closed_body(wrap);
            result.report.repairs = lines;
            break;
        }
        case RepairMethod::fill_holes: {
            result = require_closed_body(filled(tidy, lines));
            result.report.repairs.insert(result.report.repairs.begin(), lines.begin(), lines.end());
            break;
        }
        case RepairMethod::unite_shells: {
            const std::optional<TriangleMesh> one = united(tidy, report.shells, lines);
            if (!one) throw bad_input("the shells cannot be united: one of them is open or crosses itself", "ask for the alpha wrap");
            result = require_closed_body(*one);
            result.report.repairs.insert(result.report.repairs.begin(), lines.begin(), lines.end());
            break;
        }
    }
    result.before = before;
    return result;
}

}  // namespace pelletlab::meshes
