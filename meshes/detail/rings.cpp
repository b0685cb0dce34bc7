#include "meshes/detail/rings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pelletlab::meshes::detail {
namespace {

/// One step of a cap inward.
struct CapRing {
    std::uint32_t count = 0;
    double radius = 0.0;
};

/// Concentric rings inside a rim of `count` edges: each ring's edge is `growth` times the one outside it, rings lie one triangle height apart.
std::vector<CapRing> plan_cap(std::uint32_t count, double radius, double growth) {
    const double row_height = std::sqrt(3.0) / 2.0;
    std::vector<CapRing> rings;
    std::uint32_t previous = count;
    double edge = 2.0 * std::numbers::pi * radius / count;
    double r = radius;
    while (true) {
        edge *= growth;
        r -= row_height * edge;
        if (r < 0.75 * edge) break;  // what is left is closed by a fan about the centre
        const double wanted = std::round(2.0 * std::numbers::pi * r / edge);
        const auto n = static_cast<std::uint32_t>(std::clamp(wanted, 3.0, static_cast<double>(previous)));
        rings.push_back({n, r});
        previous = n;
    }
    return rings;
}

std::size_t face_count(std::uint32_t count, const std::vector<CapRing>& rings) {
    std::size_t faces = 0;
    std::uint32_t outer = count;
    for (const CapRing& ring : rings) {
        faces += outer + ring.count;
        outer = ring.count;
    }
    return faces + outer;
}

}  // namespace

std::vector<Vec3> unit_circle(std::uint32_t count, double phase) {
    std::vector<Vec3> points(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        // Whole octants are taken out first, so that a circle of 8n points is symmetric to the last bit (of 4n points about both axes).
        const double steps = 4.0 * (k + phase);  // a quadrant has `count` of them
        const double quadrant = std::floor(steps / count);
        const double rest = steps - quadrant * count;
        const bool upper_octant = 2.0 * rest > count;
        const double angle = 0.5 * std::numbers::pi * (upper_octant ? count - rest : rest) / count;
        double c = std::cos(angle), s = std::sin(angle);
        if (upper_octant) std::swap(c, s);
        if (2.0 * rest == count) s = c;
        for (int turn = 0; turn < static_cast<int>(quadrant) % 4; ++turn) {
            const double old_c = c;
            c = -s;
            s = old_c;
        }
        points[k] = Vec3(c + 0.0, s + 0.0, 0.0);
    }
    return points;
}

double circumscribed_factor(std::uint32_t facets) {
    return 1.0 / std::cos(std::numbers::pi / facets);
}

double equal_area_factor(std::uint32_t facets) {
    const double step = 2.0 * std::numbers::pi / facets;
    return std::sqrt(step / std::sin(step));
}

Ring add_ring(TriangleMesh& mesh, std::uint32_t count, double radius, double z, double phase) {
    const Ring ring{static_cast<std::uint32_t>(mesh.vertices.size()), count, phase};
    for (const Vec3& direction : unit_circle(count, phase)) mesh.vertices.emplace_back(radius * direction.x(), radius * direction.y(), z);
    return ring;
}

void add_band(TriangleMesh& mesh, const Ring& lower, const Ring& upper) {
    const auto angle = [](const Ring& ring, std::uint32_t k) { return (k + ring.phase) / ring.count; };
    std::uint32_t i = 0, j = 0;
    while (i < lower.count || j < upper.count) {
        // Advance the ring whose next vertex comes first in angle: that is the shorter new edge on concentric rings.
        const bool advance_lower = j == upper.count || (i < lower.count && angle(lower, i + 1) <= angle(upper, j + 1));
        if (advance_lower) {
            mesh.faces.push_back({lower.at(i), lower.at(i + 1), upper.at(j)});
            ++i;
        } else {
            mesh.faces.push_back({lower.at(i), upper.at(j + 1), upper.at(j)});
            ++j;
        }
    }
}

void add_flat_cap(TriangleMesh& mesh, const Ring& rim, double radius, double z, bool facing_up, std::size_t max_faces) {
    const std::size_t first_face = mesh.faces.size();
    std::vector<CapRing> plan = plan_cap(rim.count, radius, 1.0);
    for (double growth = 1.02; face_count(rim.count, plan) > max_faces && growth < 3.0; growth *= 1.02) plan = plan_cap(rim.count, radius, growth);
    Ring outer = rim;
    for (const CapRing& step : plan) {
        const Ring inner = add_ring(mesh, step.count, step.radius, z);
        add_band(mesh, outer, inner);
        outer = inner;
    }
    const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(0.0, 0.0, z);
    for (std::uint32_t k = 0; k < outer.count; ++k) mesh.faces.push_back({outer.at(k), outer.at(k + 1), centre});
    if (!facing_up) flip_faces(mesh, first_face);
}

void flip_faces(TriangleMesh& mesh, std::size_t from) {
    for (std::size_t f = from; f < mesh.faces.size(); ++f) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
}

}  // namespace pelletlab::meshes::detail
