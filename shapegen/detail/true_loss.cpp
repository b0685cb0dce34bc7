#include "shapegen/detail/true_loss.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "shapegen/detail/outer_surface.hpp"
#include "shapegen/detail/union_boundary.hpp"
#include "shapegen/detail/union_distance.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr int outer_cells = 64, fine_cells = 128;  // the fine ones are those of the quality report
constexpr std::size_t fine_from = 5000;            // points

// Mean of weight · square(distance(k)) over 0 … count − 1, the same sum whatever the number of threads.
template <class Distance, class Weight>
double weighted_mean_square(std::size_t count, const Distance& distance, const Weight& weight) {
    std::vector<double> value(count);
    parallel_for(count, 256, [&](std::size_t k) { value[k] = distance(k); });
    double sum = 0.0, total = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        sum += weight(k) * value[k] * value[k];
        total += weight(k);
    }
    return sum / total;
}

}  // namespace

double true_loss(const std::vector<Sphere>& spheres, const SampleBlocks& samples, const meshes::SignedDistance& distance, std::size_t points) {
    const std::vector<ExposedPart> boundary = union_boundary(spheres);
    const OuterSurface outer(spheres, points < fine_from ? outer_cells : fine_cells);
    const UnionDistance to_union(spheres, boundary, outer);
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / std::max<std::size_t>(1, points));
    const double first = weighted_mean_square((samples.size() + stride - 1) / stride, [&](std::size_t k) { return to_union.value(samples.points[k * stride]); },
                                              [](std::size_t) { return 1.0; });
    double area = 0.0;
    for (std::size_t i = 0; i < spheres.size(); ++i) area += boundary[i].solid_angle * spheres[i].radius * spheres[i].radius;
    const UnionSamples shown = sample_union(spheres, boundary, outer, std::sqrt(area / static_cast<double>(points)));
    const double second = weighted_mean_square(
        shown.points.size(), [&](std::size_t k) { return distance.value(shown.points[k]); }, [&](std::size_t k) { return shown.areas[k]; });
    return 0.5 * (first + second);
}

}  // namespace pelletlab::shapegen::detail
