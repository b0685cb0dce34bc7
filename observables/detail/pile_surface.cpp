#include "observables/detail/pile_surface.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/observables.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int most_rounds = 20;
constexpr std::size_t fewest_places = 3;

double height_at(const HeightGrid& grid, int i, int j) {
    return std::max(0.0, grid.height[grid.index(i, j)]);  // −∞ where no pellet is met: the plate
}

template <class Visit>
void for_each_line(const HeightGrid& grid, const Visit& visit) {
    for (int j = -grid.half_count; j <= grid.half_count; ++j)
        for (int i = -grid.half_count; i <= grid.half_count; ++i) visit(i * grid.spacing, j * grid.spacing, height_at(grid, i, j));
}

std::size_t sector_of(double x, double y) {
    const double turn = (std::atan2(y, x) + pi) / (2.0 * pi);
    return std::min(azimuth_sectors - 1, static_cast<std::size_t>(turn * static_cast<double>(azimuth_sectors)));
}

/// One Gauss–Newton step over the flank; false when the lines do not determine a cone.
bool improve(const HeightGrid& grid, Cone& cone) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    std::size_t lines = 0;
    for_each_line(grid, [&](double x, double y, double height) {
        const double dx = x - cone.x, dy = y - cone.y, distance = std::hypot(dx, dy);
        if (distance < cone.inner || distance > cone.outer || distance == 0.0) return;
        const Eigen::Vector4d gradient(1.0, -distance, cone.slope * dx / distance, cone.slope * dy / distance);
        normal += gradient * gradient.transpose();
        right += gradient * (height - (cone.apex - cone.slope * distance));
        ++lines;
    });
    if (lines < 8) return false;
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    if (!step.allFinite()) return false;
    cone.apex += step[0];
    cone.slope += step[1];
    cone.x += step[2];
    cone.y += step[3];
    return true;
}

void fit_sectors(const HeightGrid& grid, Cone& cone) {
    std::array<std::vector<double>, azimuth_sectors> distances, heights;
    for_each_line(grid, [&](double x, double y, double height) {
        const double dx = x - cone.x, dy = y - cone.y, distance = std::hypot(dx, dy);
        if (distance < cone.inner || distance > cone.outer) return;
        const std::size_t sector = sector_of(dx, dy);
        distances[sector].push_back(distance);
        heights[sector].push_back(height);
    });
    for (std::size_t s = 0; s < azimuth_sectors; ++s) {
        const LineFit line = fit_line(distances[s], heights[s]);
        cone.sector_angle[s] = std::atan(-line.slope);
        cone.sector_apex[s] = line.intercept;
    }
}

}  // namespace

double smoothed_height(const HeightGrid& grid, double side) {
    const std::size_t n = grid.side(), window = std::min(n, std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(side / grid.spacing))));
    std::vector<double> sum((n + 1) * (n + 1), 0.0);  // of all lines before (row, column)
    for (std::size_t r = 0; r < n; ++r)
        for (std::size_t c = 0; c < n; ++c)
            sum[(r + 1) * (n + 1) + c + 1] =
                std::max(0.0, grid.height[r * n + c]) + sum[r * (n + 1) + c + 1] + sum[(r + 1) * (n + 1) + c] - sum[r * (n + 1) + c];
    double highest = 0.0;
    for (std::size_t r = 0; r + window <= n; ++r)
        for (std::size_t c = 0; c + window <= n; ++c) {
            const double inside =
                sum[(r + window) * (n + 1) + c + window] - sum[r * (n + 1) + c + window] - sum[(r + window) * (n + 1) + c] + sum[r * (n + 1) + c];
            highest = std::max(highest, inside / static_cast<double>(window * window));
        }
    return highest;
}

RingMeans ring_means(const HeightGrid& grid, double x, double y, double ring) {
    const double reach = grid.half_count * grid.spacing - std::max(std::abs(x), std::abs(y));  // rings that lie on the grid as a whole
    const auto rings = static_cast<std::size_t>(std::max(0.0, std::floor(reach / ring)));
    RingMeans means;
    means.mean.assign(rings, 0.0);
    means.sector.assign(rings, {});
    std::vector<std::array<std::size_t, azimuth_sectors>> count(rings, std::array<std::size_t, azimuth_sectors>{});
    for (std::size_t k = 0; k < rings; ++k) means.distance.push_back((static_cast<double>(k) + 0.5) * ring);
    for_each_line(grid, [&](double line_x, double line_y, double height) {
        const double dx = line_x - x, dy = line_y - y;
        const auto k = static_cast<std::size_t>(std::hypot(dx, dy) / ring);
        if (k >= rings) return;
        means.sector[k][sector_of(dx, dy)] += height;
        ++count[k][sector_of(dx, dy)];
    });
    for (std::size_t k = 0; k < rings; ++k) {
        double sum = 0.0, lines = 0.0;
        for (std::size_t s = 0; s < azimuth_sectors; ++s) {
            sum += means.sector[k][s];
            lines += static_cast<double>(count[k][s]);
            means.sector[k][s] = count[k][s] > 0 ? means.sector[k][s] / static_cast<double>(count[k][s]) : not_known;
        }
        means.mean[k] = lines > 0.0 ? sum / lines : not_known;
    }
    return means;
}

double first_below(const std::vector<double>& distance, const std::vector<double>& mean, double height) {
    for (std::size_t k = 0; k < mean.size(); ++k) {
        if (!(mean[k] < height)) continue;
        if (k == 0) return distance[0];
        return distance[k - 1] + (distance[k] - distance[k - 1]) * (mean[k - 1] - height) / (mean[k - 1] - mean[k]);
    }
    return not_known;
}

Cone fit_cone(const HeightGrid& grid, double height, double ring) {
    Cone cone;
    double weight = 0.0;
    for_each_line(grid, [&](double x, double y, double z) {  // start at the centre of the part above half the height
        if (z < 0.5 * height) return;
        cone.x += x;
        cone.y += y;
        weight += 1.0;
    });
    if (weight == 0.0) return cone;
    cone.x /= weight;
    cone.y /= weight;
    for (int round = 0; round < most_rounds; ++round) {
        const double old_x = cone.x, old_y = cone.y, old_slope = cone.slope;
        const RingMeans rings = ring_means(grid, cone.x, cone.y, ring);
        cone.inner = first_below(rings.distance, rings.mean, flank_top * height);
        cone.outer = first_below(rings.distance, rings.mean, flank_foot * height);
        if (!(cone.outer - cone.inner >= 2.0 * ring)) return cone;
        if (round == 0) {
            cone.slope = (flank_top - flank_foot) * height / (cone.outer - cone.inner);
            cone.apex = flank_top * height + cone.slope * cone.inner;
        }
        if (!improve(grid, cone) || !(std::hypot(cone.x, cone.y) < grid.half_count * grid.spacing)) return cone;
        if (std::hypot(cone.x - old_x, cone.y - old_y) < 0.01 * grid.spacing && std::abs(cone.slope - old_slope) < 1e-6) break;
    }
    cone.found = cone.slope > 0.0;
    if (cone.found) fit_sectors(grid, cone);
    return cone;
}

Silhouette silhouette(const HeightGrid& grid, bool along_x) {
    Silhouette outline;
    for (int u = -grid.half_count; u <= grid.half_count; ++u) {
        double highest = 0.0;
        for (int v = -grid.half_count; v <= grid.half_count; ++v) highest = std::max(highest, along_x ? height_at(grid, u, v) : height_at(grid, v, u));
        outline.place.push_back(u * grid.spacing);
        outline.height.push_back(highest);
    }
    return outline;
}

std::array<double, 2> flank_angles(const Silhouette& outline) {
    const auto n = static_cast<std::ptrdiff_t>(outline.height.size());
    const auto peak = std::max_element(outline.height.begin(), outline.height.end()) - outline.height.begin();
    const double height = outline.height[static_cast<std::size_t>(peak)];
    std::array<double, 2> angles{not_known, not_known};
    for (const int side : {-1, 1}) {
        std::vector<double> distance, z;
        for (std::ptrdiff_t k = peak; k >= 0 && k < n; k += side) {
            const auto at = static_cast<std::size_t>(k);
            if (outline.height[at] < flank_foot * height) break;
            if (distance.empty() && outline.height[at] >= flank_top * height) continue;
            distance.push_back(side * outline.place[at]);
            z.push_back(outline.height[at]);
        }
        if (distance.size() >= fewest_places) angles[side < 0 ? 0 : 1] = std::atan(-fit_line(distance, z).slope);
    }
    return angles;
}

}  // namespace pelletlab::observables::detail
