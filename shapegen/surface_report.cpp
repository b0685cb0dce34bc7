#include "shapegen/surface_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/detail/edge_band.hpp"
#include "shapegen/detail/known_union.hpp"
#include "shapegen/detail/smooth_patches.hpp"
#include "shapegen/detail/surface_samples.hpp"
#include "shapegen/detail/union_boundary.hpp"
#include "shapegen/detail/union_distance.hpp"

namespace pelletlab::shapegen {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t height_points = 20000;
constexpr double normal_points = 10000.0;
constexpr std::size_t directions = 4000;

Vec3 fibonacci(std::size_t k, std::size_t n) {
    const double z = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(n);
    const double turn = (static_cast<double>(k) + 0.5) * std::numbers::pi * (3.0 - std::sqrt(5.0));
    return {std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z};
}

// Height of the union over p along n, looking from `limit` above the surface; NaN where the line meets no sphere below that.
double height(std::span<const Sphere> spheres, const Vec3& p, const Vec3& n, double limit) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Sphere& s : spheres) {
        const Vec3 offset = s.centre - p;
        const double along = offset.dot(n), aside = offset.squaredNorm() - along * along;
        const double left = s.radius * s.radius - aside;
        if (left <= 0.0) continue;
        const double top = along + std::sqrt(left), bottom = along - std::sqrt(left);
        if (bottom < limit) highest = std::max(highest, std::min(top, limit));
    }
    return std::isfinite(highest) ? highest : nothing;
}

void measure_roughness(std::span<const Sphere> spheres, const TriangleMesh& body, const detail::SmoothPatches& patches, double band, SurfaceReport& report) {
    const detail::SurfaceSamples samples = detail::sample_surface(body, height_points, 2);
    std::vector<double> heights(samples.points.size(), nothing);
    const detail::EdgeBand left_out(patches.edges, band);
    parallel_for(samples.points.size(), 256, [&](std::size_t i) {
        const Vec3& p = samples.points[i];
        if (left_out.holds(p)) return;
        heights[i] = height(spheres, p, samples.normals[i], 2.0 * band);
    });
    struct Sums {
        double n = 0, sum = 0, squares = 0, low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    };
    std::vector<Sums> sums(patches.count);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if (std::isnan(heights[i])) continue;
        Sums& of = sums[patches.patch_of_face[samples.faces[i]]];
        of.n += 1.0;
        of.sum += heights[i];
        of.squares += heights[i] * heights[i];
        of.low = std::min(of.low, heights[i]);
        of.high = std::max(of.high, heights[i]);
    }
    report.patches.resize(patches.count);
    for (std::size_t f = 0; f < body.faces.size(); ++f) {
        PatchRoughness& patch = report.patches[patches.patch_of_face[f]];
        const Vec3 area = 0.5 * (body.corner(f, 1) - body.corner(f, 0)).cross(body.corner(f, 2) - body.corner(f, 0));
        patch.mean_normal += area;
        patch.area += area.norm();
    }
    double flat = 0.0, flat_n = 0.0, curved = 0.0, curved_n = 0.0;
    report.flat_sz = report.curved_sz = 0.0;
    for (std::size_t k = 0; k < patches.count; ++k) {
        PatchRoughness& patch = report.patches[k];
        patch.mean_normal /= patch.area;
        patch.points = static_cast<std::size_t>(sums[k].n);
        if (patch.points == 0) continue;
        patch.mean = sums[k].sum / sums[k].n;
        const double variance = std::max(0.0, sums[k].squares / sums[k].n - patch.mean * patch.mean);
        patch.sq = std::sqrt(variance);
        patch.sz = sums[k].high - sums[k].low;
        const bool is_flat = patch.mean_normal.norm() > 0.9999;
        (is_flat ? flat : curved) += variance * sums[k].n;
        (is_flat ? flat_n : curved_n) += sums[k].n;
        double& worst = is_flat ? report.flat_sz : report.curved_sz;
        worst = std::max(worst, patch.sz);
    }
    report.flat_sq = flat_n > 0.0 ? std::sqrt(flat / flat_n) : nothing;
    report.curved_sq = curved_n > 0.0 ? std::sqrt(curved / curved_n) : nothing;
    if (flat_n == 0.0) report.flat_sz = nothing;
    if (curved_n == 0.0) report.curved_sz = nothing;
    std::stable_sort(report.patches.begin(), report.patches.end(), [](const PatchRoughness& a, const PatchRoughness& b) { return a.area > b.area; });
}

void measure_normals(std::span<const Sphere> spheres, std::span<const detail::ExposedPart> boundary, const detail::OuterSurface& outer,
                     const meshes::SignedDistance& exact, SurfaceReport& report) {
    double area = 0.0;
    for (std::size_t i = 0; i < spheres.size(); ++i) area += boundary[i].solid_angle * spheres[i].radius * spheres[i].radius;
    const detail::UnionSamples samples = detail::sample_union(spheres, boundary, outer, std::sqrt(area / normal_points));
    std::vector<std::pair<double, double>> angles(samples.points.size());
    parallel_for(samples.points.size(), 256, [&](std::size_t i) {
        const double cosine = std::clamp(samples.normals[i].dot(exact.gradient(samples.points[i])), -1.0, 1.0);
        angles[i] = {std::acos(cosine), samples.areas[i]};
    });
    double total = 0.0, squares = 0.0;
    report.normal_mean = 0.0;
    for (const auto& [angle, weight] : angles) {
        total += weight;
        report.normal_mean += weight * angle;
        squares += weight * angle * angle;
    }
    report.normal_mean /= total;
    report.normal_rms = std::sqrt(squares / total);
    std::sort(angles.begin(), angles.end());
    double below = 0.0;
    for (const auto& [angle, weight] : angles) {
        below += weight;
        report.normal_p95 = angle;
        if (below >= 0.95 * total) break;
    }
}

void measure_edges(std::span<const Sphere> spheres, const std::vector<detail::SharpEdge>& edges, double spacing, SurfaceReport& report) {
    double gaps = 0.0, radii = 0.0, length = 0.0;
    report.edge_gap_max = report.edge_radius_max = -std::numeric_limits<double>::infinity();
    for (const detail::SharpEdge& edge : edges) {
        if (edge.inner_angle >= std::numbers::pi) continue;
        const int pieces = std::max(1, static_cast<int>(std::ceil((edge.b - edge.a).norm() / spacing)));
        for (int k = 0; k <= pieces; ++k) {
            const double weight = (edge.b - edge.a).norm() / pieces * (k == 0 || k == pieces ? 0.5 : 1.0);
            const Vec3 p = edge.a + (edge.b - edge.a) * (static_cast<double>(k) / pieces);
            const double up = height(spheres, p, -edge.inward, std::numeric_limits<double>::infinity());
            if (std::isnan(up)) continue;
            const double gap = -up;
            const double radius = gap / (1.0 / std::sin(0.5 * edge.inner_angle) - 1.0);
            gaps += weight * gap;
            radii += weight * radius;
            length += weight;
            report.edge_gap_max = std::max(report.edge_gap_max, gap);
            report.edge_radius_max = std::max(report.edge_radius_max, radius);
        }
    }
    if (length == 0.0) {
        report.edge_gap_mean = report.edge_gap_max = report.edge_radius_mean = report.edge_radius_max = nothing;
        return;
    }
    report.edge_gap_mean = gaps / length;
    report.edge_radius_mean = radii / length;
}

std::size_t contacts(std::span<const Sphere> spheres, const Vec3& n, double press, double& support) {
    support = -std::numeric_limits<double>::infinity();
    for (const Sphere& s : spheres) support = std::max(support, n.dot(s.centre) + s.radius);
    std::size_t count = 0;
    for (const Sphere& s : spheres) count += n.dot(s.centre) + s.radius > support - press ? 1 : 0;
    return count;
}

void measure_planes(std::span<const Sphere> spheres, const TriangleMesh& body, SurfaceReport& report) {
    struct Row {
        double error = 0.0;
        std::size_t count = 0;
    };
    std::vector<Row> rows(directions);
    parallel_for(directions, 32, [&](std::size_t k) {
        const Vec3 n = fibonacci(k, directions);
        double of_body = -std::numeric_limits<double>::infinity(), of_union = 0.0;
        for (const Vec3& vertex : body.vertices) of_body = std::max(of_body, n.dot(vertex));
        rows[k].count = contacts(spheres, n, report.press, of_union);
        rows[k].error = of_union - of_body;
    });
    double squares = 0.0;
    report.support_mean = report.support_max = report.contacts_any_way = 0.0;
    for (const Row& row : rows) {
        report.support_mean += row.error / static_cast<double>(directions);
        squares += row.error * row.error / static_cast<double>(directions);
        report.support_max = std::max(report.support_max, std::abs(row.error));
        report.contacts_any_way += static_cast<double>(row.count) / static_cast<double>(directions);
        report.most_any_way = std::max(report.most_any_way, row.count);
    }
    report.support_rms = std::sqrt(squares);
    double sum = 0.0, faces = 0.0, unused = 0.0;
    for (const PatchRoughness& patch : report.patches) {
        if (patch.mean_normal.norm() <= 0.9999) continue;
        const std::size_t count = contacts(spheres, patch.mean_normal.normalized(), report.press, unused);
        sum += static_cast<double>(count);
        faces += 1.0;
        report.most_on_flat = std::max(report.most_on_flat, count);
    }
    report.contacts_on_flat = faces > 0.0 ? sum / faces : nothing;
}

std::size_t component_count(std::span<const Sphere> spheres) {
    const auto neighbours = detail::overlapping_neighbours(spheres);
    std::vector<std::uint8_t> seen(spheres.size(), 0);
    std::size_t count = 0;
    for (std::size_t start = 0; start < spheres.size(); ++start) {
        if (seen[start]) continue;
        ++count;
        std::vector<std::size_t> todo = {start};
        seen[start] = 1;
        while (!todo.empty()) {
            const std::size_t i = todo.back();
            todo.pop_back();
            for (const std::uint32_t j : neighbours[i]) {
                if (seen[j]) continue;
                seen[j] = 1;
                todo.push_back(j);
            }
        }
    }
    return count;
}

}  // namespace

SurfaceReport measure_surface(std::span<const Sphere> spheres, const TriangleMesh& body, const meshes::SignedDistance& exact,
                              const SurfaceReportSettings& settings) {
    return detail::measure_surface(detail::KnownUnion(spheres), body, exact, settings);
}

SurfaceReport detail::measure_surface(const KnownUnion& known, const TriangleMesh& body, const meshes::SignedDistance& exact,
                                      const SurfaceReportSettings& settings) {
    const std::span<const Sphere> spheres = known.spheres;
    SurfaceReport report;
    const double extent = bounding_box(body).sizes().minCoeff();
    const detail::SmoothPatches patches = detail::smooth_patches(body, settings.sharp_angle);
    measure_roughness(spheres, body, patches, settings.edge_band * extent, report);
    measure_normals(spheres, known.boundary, known.outer, exact, report);
    measure_edges(spheres, patches.edges, extent / 200.0, report);
    report.press = settings.press > 0.0 ? settings.press : extent / 300.0;
    measure_planes(spheres, body, report);
    report.smallest_radius = std::numeric_limits<double>::infinity();
    report.largest_radius = 0.0;
    for (const Sphere& s : spheres) {
        report.smallest_radius = std::min(report.smallest_radius, s.radius);
        report.largest_radius = std::max(report.largest_radius, s.radius);
        report.sum_volume += 4.0 / 3.0 * std::numbers::pi * s.radius * s.radius * s.radius;
    }
    report.components = component_count(spheres);
    report.sealed_volume = known.outer.sealed_volume();
    Box box;
    for (const Sphere& s : spheres) box.extend(s.centre);
    report.union_volume = detail::union_moments(spheres, known.boundary, box.center()).volume;
    report.mesh_volume = meshes::mass_properties(body, 1.0).volume;
    return report;
}

}  // namespace pelletlab::shapegen
