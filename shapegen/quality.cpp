#include "shapegen/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/detail/column_overlap.hpp"
#include "shapegen/detail/known_union.hpp"
#include "shapegen/detail/surface_samples.hpp"
#include "shapegen/detail/union_boundary.hpp"
#include "shapegen/detail/union_distance.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen {

namespace {

constexpr std::size_t surface_samples = 40000;  // of each direction; means then scatter by about 0.2 %
constexpr int overlap_columns = 500;

// Distances with weights; extremes carry no weight, they only count for the maximum.
struct Distances {
    std::vector<double> value, weight;
    double extreme = 0.0;
};

DistanceFigures figures(const Distances& distances) {
    DistanceFigures result;
    const double total = std::accumulate(distances.weight.begin(), distances.weight.end(), 0.0);
    std::vector<std::pair<double, double>> sorted;
    sorted.reserve(distances.value.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < distances.value.size(); ++i) {
        const double d = std::abs(distances.value[i]), w = distances.weight[i] / total;
        result.mean += w * d;
        result.signed_mean += w * distances.value[i];
        squares += w * d * d;
        sorted.emplace_back(d, w);
    }
    result.rms = std::sqrt(squares);
    // The largest one percent by weight lies within the last twentieth by number, unless weights differ wildly.
    const auto tail = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() - sorted.size() / 20 - 1);
    std::nth_element(sorted.begin(), tail, sorted.end());
    std::sort(tail, sorted.end());
    double in_tail = 0.0;
    for (auto it = tail; it != sorted.end(); ++it) in_tail += it->second;
    if (in_tail <= 0.01) std::sort(sorted.begin(), tail);
    result.max = std::max(sorted.back().first, distances.extreme);
    double beyond = 0.0;
    for (auto it = sorted.rbegin(); it != sorted.rend() && beyond <= 0.01; ++it) {
        result.p99 = it->first;
        beyond += it->second;
    }
    return result;
}

Distances target_to_union(const TriangleMesh& body, const detail::UnionDistance& to_union) {
    const detail::SurfaceSamples samples = detail::sample_surface(body, surface_samples, 1);
    Distances distances;
    distances.value.resize(samples.points.size());
    distances.weight.assign(samples.points.size(), 1.0);
    parallel_for(samples.points.size(), 512, [&](std::size_t i) { distances.value[i] = to_union.value(samples.points[i]); });
    // Corners and edges are where the largest distance sits.
    std::vector<Vec3> extremes = body.vertices;
    for (std::size_t f = 0; f < body.faces.size(); ++f) {
        for (int k = 0; k < 3; ++k) extremes.push_back(0.5 * (body.corner(f, k) + body.corner(f, (k + 1) % 3)));
    }
    distances.extreme = parallel_reduce(
        extremes.size(), 512, 0.0,
        [&](std::size_t begin, std::size_t end) {
            double largest = 0.0;
            for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, std::abs(to_union.value(extremes[i])));
            return largest;
        },
        [](double a, double b) { return std::max(a, b); });
    return distances;
}

std::vector<double> values(const meshes::SignedDistance& distance, const std::vector<Vec3>& points) {
    std::vector<double> result(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) { result[i] = distance.value(points[i]); });
    return result;
}

Distances union_to_target(std::span<const Sphere> spheres, std::span<const detail::ExposedPart> boundary, const detail::OuterSurface& outer,
                          const meshes::SignedDistance& exact) {
    double area = 0.0;
    for (std::size_t i = 0; i < spheres.size(); ++i) area += boundary[i].solid_angle * spheres[i].radius * spheres[i].radius;
    detail::UnionSamples samples = detail::sample_union(spheres, boundary, outer, std::sqrt(area / static_cast<double>(surface_samples)));
    if (samples.points.empty()) throw numerical_failure("the union of spheres shows no surface", "check the spheres");
    Distances distances;
    distances.value = values(exact, samples.points);
    distances.weight = std::move(samples.areas);
    // The deepest points of the surface are where three spheres meet: the ends of the arcs.
    std::vector<Vec3> ends;
    for (const detail::ExposedPart& part : boundary) {
        for (const detail::ExposedArc& arc : part.arcs) {
            const Sphere& s = spheres[arc.sphere];
            const Vec3 end = s.centre + s.radius * (arc.cos_opening * arc.axis + arc.sin_opening * (arc.u * std::cos(arc.begin) + arc.v * std::sin(arc.begin)));
            if (outer.reaches(end)) ends.push_back(end);
        }
    }
    for (const double d : values(exact, ends)) distances.extreme = std::max(distances.extreme, std::abs(d));
    return distances;
}

// Of the two directions together: each counts one half.
DistanceFigures together(const Distances& a, const Distances& b) {
    Distances pooled;
    pooled.extreme = std::max(a.extreme, b.extreme);
    for (const Distances* part : {&a, &b}) {
        const double total = std::accumulate(part->weight.begin(), part->weight.end(), 0.0);
        pooled.value.insert(pooled.value.end(), part->value.begin(), part->value.end());
        for (const double w : part->weight) pooled.weight.push_back(w / total);
    }
    return figures(pooled);
}

Vec3 ascending(Vec3 v) {
    std::sort(v.data(), v.data() + 3);
    return v;
}

}  // namespace

FitQuality measure_quality(std::span<const Sphere> spheres, const TriangleMesh& body, const meshes::SignedDistance& exact) {
    return detail::measure_quality(detail::KnownUnion(spheres), body, exact);
}

FitQuality detail::measure_quality(const KnownUnion& known, const TriangleMesh& body, const meshes::SignedDistance& exact) {
    const std::span<const Sphere> spheres = known.spheres;
    FitQuality quality;
    const MassProperties target = meshes::mass_properties(body, 1.0);
    const MassProperties clump = union_mass_properties(spheres, 1.0);
    quality.volume_error = clump.volume / target.volume - 1.0;
    quality.inertia_error = ascending(clump.principal_inertia).cwiseQuotient(ascending(target.principal_inertia)) - Vec3::Ones();
    quality.centre_offset = (clump.centre_of_mass_mesh - target.centre_of_mass_mesh).norm();
    const detail::OverlapVolumes overlap = detail::column_overlap(body, spheres, overlap_columns);
    quality.missing = overlap.missing / target.volume;
    quality.outside = overlap.outside / target.volume;
    quality.symmetric_difference = quality.missing + quality.outside;

    const Distances forth = target_to_union(body, UnionDistance(spheres, known.boundary, known.outer));
    const Distances back = union_to_target(spheres, known.boundary, known.outer, exact);
    quality.target_to_union = figures(forth);
    quality.union_to_target = figures(back);
    quality.both = together(forth, back);
    quality.both.signed_mean = 0.5 * (quality.union_to_target.signed_mean - quality.target_to_union.signed_mean);
    quality.distance_error_bound = exact.error_bound();
    return quality;
}

}  // namespace pelletlab::shapegen
