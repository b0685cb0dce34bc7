#include "shapegen/detail/seeding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "shapegen/detail/medial_balls.hpp"

namespace pelletlab::shapegen::detail {

namespace {

// Gaps of all points, with the largest one of each group of blocks: most groups are too far from a new ball to change.
struct Gaps {
    std::vector<double> gap;
    std::vector<double> group_largest;
    std::vector<std::size_t> group_where;
};

}  // namespace

std::vector<Sphere> seed_by_gaps(const SampleBlocks& samples, const meshes::SignedDistance& distance, const SeedSettings& settings) {
    const std::size_t n = samples.size();
    constexpr std::size_t stretch = SampleBlocks::width * SampleBlocks::group;
    const std::size_t groups = samples.group_count();
    const auto ball_at = [&](std::size_t i) {
        const double r = std::max({settings.min_radius, 2.0 * settings.tolerance,
                                   medial_radius(distance, samples.points[i], samples.normals[i], settings.largest_radius, settings.tolerance)});
        return Sphere{samples.points[i] - r * samples.normals[i], r};
    };

    // The first ball: the largest one among a few points spread over the surface.
    std::vector<Sphere> balls;
    {
        const std::size_t tries = std::min<std::size_t>(n, 256);
        std::vector<Sphere> candidates(tries);
        parallel_for(tries, 16, [&](std::size_t k) { candidates[k] = ball_at(k * n / tries); });
        balls.push_back(*std::max_element(candidates.begin(), candidates.end(), [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; }));
    }

    Gaps gaps{std::vector<double>(n, std::numeric_limits<double>::infinity()), std::vector<double>(groups, std::numeric_limits<double>::infinity()),
              std::vector<std::size_t>(groups, 0)};
    while (balls.size() < settings.count) {
        const Sphere& last = balls.back();
        parallel_for(groups, 32, [&](std::size_t g) {
            const Vec3 m(samples.group_x[g], samples.group_y[g], samples.group_z[g]);
            if ((m - last.centre).norm() - last.radius - samples.group_radius[g] > gaps.group_largest[g]) return;
            double largest = -std::numeric_limits<double>::infinity();
            for (std::size_t i = g * stretch; i < std::min(n, (g + 1) * stretch); ++i) {
                gaps.gap[i] = std::min(gaps.gap[i], (samples.points[i] - last.centre).norm() - last.radius);
                if (gaps.gap[i] > largest) {
                    largest = gaps.gap[i];
                    gaps.group_where[g] = i;
                }
            }
            gaps.group_largest[g] = largest;
        });
        const auto worst = std::max_element(gaps.group_largest.begin(), gaps.group_largest.end());
        balls.push_back(ball_at(gaps.group_where[static_cast<std::size_t>(worst - gaps.group_largest.begin())]));
    }
    return balls;
}

}  // namespace pelletlab::shapegen::detail
