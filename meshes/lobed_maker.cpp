// Lobed extrudates: an outline of equal arcs, stacked along z and closed by caps of shrinking outlines.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "meshes/detail/require.hpp"
#include "meshes/detail/revolve.hpp"
#include "meshes/detail/rings.hpp"
#include "meshes/pellet_makers.hpp"

namespace pelletlab::meshes {
namespace {

constexpr double pi = std::numbers::pi;

/// Cross-section: arcs of radius r about centres at distance c; neighbouring arcs meet in grooves at distance q, seen from a centre at angles ±beta off its
/// axis.
struct Section {
    std::uint32_t lobes = 3;
    double r = 0.0, c = 0.0, q = 0.0, beta = 0.0;

    /// `per_lobe` points on each arc; each arc starts in a groove.
    std::vector<Vec3> outline(std::uint32_t per_lobe) const {
        std::vector<Vec3> points;
        for (std::uint32_t lobe = 0; lobe < lobes; ++lobe) {
            const double axis = 2.0 * pi * lobe / lobes;
            for (std::uint32_t k = 0; k < per_lobe; ++k) {
                const double angle = axis - beta + 2.0 * beta * k / per_lobe;
                points.emplace_back(c * std::cos(axis) + r * std::cos(angle), c * std::sin(axis) + r * std::sin(angle), 0.0);
            }
        }
        return points;
    }
    double perimeter() const { return lobes * 2.0 * beta * r; }
    double area() const { return lobes * (c * q * std::sin(pi / lobes) + r * r * beta); }
};

Section section_of(const LobedExtrudate& b) {
    detail::require_positive(b.lobe_diameter, "lobe diameter");
    detail::require_positive(b.height, "height");
    if (b.lobes < 2 || b.lobes > 12)
        throw bad_input("an extrudate has between 2 and 12 lobes, but " + std::to_string(b.lobes) + " were asked for", "a trilobe has 3");
    const double r = 0.5 * b.lobe_diameter, c = b.lobe_offset, half = pi / b.lobes;
    if (!(c > 0.0) || !(c * std::sin(half) < r * (1.0 - 1e-6)))
        throw bad_input("the lobes of an extrudate do not overlap, or lie on the axis", "choose 0 < lobe_offset < lobe_diameter / (2 sin(pi / lobes))");
    Section s{b.lobes, r, c, 0.0, 0.0};
    s.q = c * std::cos(half) + std::sqrt(r * r - c * c * std::sin(half) * std::sin(half));
    s.beta = std::atan2(s.q * std::sin(half), s.q * std::cos(half) - c);
    return s;
}

/// Ring of outline points; per-lobe counts differ from ring to ring and grooves stay in line.
struct Loop {
    std::uint32_t first = 0, per_lobe = 0;
};

Loop add_loop(TriangleMesh& mesh, const Section& section, std::uint32_t per_lobe, double scale, double z) {
    const Loop loop{static_cast<std::uint32_t>(mesh.vertices.size()), per_lobe};
    for (const Vec3& p : section.outline(per_lobe)) mesh.vertices.emplace_back(scale * p.x(), scale * p.y(), z);
    return loop;
}

/// Triangles between two loops, lobe by lobe; the facing rules of add_band.
void add_loop_band(TriangleMesh& mesh, const Section& section, const Loop& lower, const Loop& upper) {
    const std::uint32_t n = lower.per_lobe, m = upper.per_lobe;
    for (std::uint32_t lobe = 0; lobe < section.lobes; ++lobe) {
        const auto low = [&](std::uint32_t k) { return lower.first + (lobe * n + k) % (section.lobes * n); };
        const auto high = [&](std::uint32_t k) { return upper.first + (lobe * m + k) % (section.lobes * m); };
        std::uint32_t i = 0, j = 0;
        while (i < n || j < m) {
            if (j == m || (i < n && (i + 1) * m <= (j + 1) * n)) {
                mesh.faces.push_back({low(i), low(i + 1), high(j)});
                ++i;
            } else {
                mesh.faces.push_back({low(i), high(j + 1), high(j)});
                ++j;
            }
        }
    }
}

void add_lobed_cap(TriangleMesh& mesh, const Section& section, const Loop& rim, double z, bool facing_up, double edge) {
    const std::size_t first_face = mesh.faces.size();
    const double reach = section.c + section.r;
    const auto steps = detail::piece_count(reach, edge, section.lobes * rim.per_lobe, 3);
    Loop outer = rim;
    for (std::uint32_t k = 1; k < steps; ++k) {
        const double scale = 1.0 - static_cast<double>(k) / steps;
        const auto wanted = static_cast<std::uint32_t>(std::ceil(scale * rim.per_lobe));
        const Loop inner = add_loop(mesh, section, std::max(std::min(rim.per_lobe, 4U), wanted), scale, z);
        add_loop_band(mesh, section, outer, inner);
        outer = inner;
    }
    const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(0.0, 0.0, z);
    const std::uint32_t count = section.lobes * outer.per_lobe;
    for (std::uint32_t k = 0; k < count; ++k) mesh.faces.push_back({outer.first + k, outer.first + (k + 1) % count, centre});
    if (!facing_up) detail::flip_faces(mesh, first_face);
}

}  // namespace

double exact_volume(const LobedExtrudate& b) {
    return section_of(b).area() * b.height;
}

TriangleMesh make_pellet(const LobedExtrudate& b, std::uint32_t facets, bool volume_exact) {
    const Section section = section_of(b);
    detail::require_facets(facets, 4 * b.lobes);
    const std::uint32_t per_lobe = (facets + b.lobes - 1) / b.lobes;
    const double edge = section.perimeter() / (per_lobe * b.lobes);
    const std::uint32_t rows = detail::piece_count(b.height, edge, per_lobe * b.lobes);
    TriangleMesh mesh;
    std::vector<Loop> loops;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        loops.push_back(add_loop(mesh, section, per_lobe, 1.0, b.height * (static_cast<double>(row) / rows - 0.5)));
        if (row > 0) add_loop_band(mesh, section, loops[row - 1], loops[row]);
    }
    add_lobed_cap(mesh, section, loops.back(), 0.5 * b.height, true, edge);
    add_lobed_cap(mesh, section, loops.front(), -0.5 * b.height, false, edge);
    if (volume_exact) detail::scale_radii_to_volume(mesh, exact_volume(b));
    return mesh;
}

}  // namespace pelletlab::meshes
