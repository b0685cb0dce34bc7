#include "observables/detail/free_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/observables.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables::detail {

namespace {

/// Sums over rectangles of cells in constant time: sum(c, r) holds all cells with column < c and row < r.
class SummedArea {
public:
    SummedArea(const ViewGrid& grid, const std::vector<double>& value) : columns_(grid.columns + 1), sum_(columns_ * (grid.rows + 1), 0.0) {
        for (std::size_t r = 0; r < grid.rows; ++r)
            for (std::size_t c = 0; c < grid.columns; ++c)
                sum_[(r + 1) * columns_ + c + 1] =
                    value[r * grid.columns + c] + sum_[r * columns_ + c + 1] + sum_[(r + 1) * columns_ + c] - sum_[r * columns_ + c];
    }
    double over(std::size_t c0, std::size_t c1, std::size_t r0, std::size_t r1) const {
        return sum_[r1 * columns_ + c1] - sum_[r0 * columns_ + c1] - sum_[r1 * columns_ + c0] + sum_[r0 * columns_ + c0];
    }

private:
    std::size_t columns_;
    std::vector<double> sum_;
};

/// Half-width in cells of a window of that length: the window has 2k + 1 cells.
std::size_t half_window(double length, double step) {
    return static_cast<std::size_t>(std::lround(std::max(0.0, 0.5 * (length / step - 1.0))));
}

/// The angle below the horizontal of a line of slope dη/dξ in the chord frame.
double world_angle(double slope, const ChordFrame& chord) {
    return chord.inclination() - std::atan(slope);
}

}  // namespace

std::vector<double> packing_field(const ViewGrid& grid, const std::vector<double>& volume, double frames, const SurfaceSettings& settings) {
    const std::vector<double> area = grid.area_inside(settings.drum_radius);
    const SummedArea volumes(grid, volume), areas(grid, area);
    const std::size_t wide = half_window(settings.pellet_diameter, grid.step_a), high = half_window(0.5 * settings.pellet_diameter, grid.step_b);
    std::vector<double> packing(grid.cells(), not_known);
    for (std::size_t r = 0; r < grid.rows; ++r)
        for (std::size_t c = 0; c < grid.columns; ++c) {
            if (area[r * grid.columns + c] <= 0.0) continue;
            const std::size_t c0 = c > wide ? c - wide : 0, c1 = std::min(c + wide + 1, grid.columns);
            const std::size_t r0 = r > high ? r - high : 0, r1 = std::min(r + high + 1, grid.rows);
            packing[r * grid.columns + c] = volumes.over(c0, c1, r0, r1) / (areas.over(c0, c1, r0, r1) * settings.drum_length * frames);
        }
    return packing;
}

double bulk_packing_fraction(const ViewGrid& grid, const std::vector<double>& volume, double frames, const SurfaceSettings& settings) {
    const std::vector<double> area = grid.area_inside(settings.drum_radius);
    const SummedArea volumes(grid, volume), areas(grid, area);
    const auto wide = static_cast<std::size_t>(std::max(1.0, std::round(settings.pellet_diameter / grid.step_a)));
    const auto high = static_cast<std::size_t>(std::max(1.0, std::round(settings.pellet_diameter / grid.step_b)));
    const double full_cell = grid.step_a * static_cast<double>(wide) * grid.step_b * static_cast<double>(high);
    struct Cell {
        double packing, volume;
    };
    std::vector<Cell> cells;
    double total = 0.0;
    for (std::size_t r = 0; r < grid.rows; r += high)
        for (std::size_t c = 0; c < grid.columns; c += wide) {
            const std::size_t c1 = std::min(c + wide, grid.columns), r1 = std::min(r + high, grid.rows);
            const double inside = areas.over(c, c1, r, r1), solid = volumes.over(c, c1, r, r1);
            if (inside < 0.25 * full_cell || solid <= 0.0) continue;  // slivers along the wall are too noisy to rank
            cells.push_back({solid / (inside * settings.drum_length * frames), solid});
            total += solid;
        }
    std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.packing < b.packing; });
    double below = 0.0;
    for (const Cell& cell : cells) {
        below += cell.volume;
        if (below >= 0.5 * total) return cell.packing;
    }
    return not_known;
}

FreeSurface free_surface(const ViewGrid& grid, const std::vector<double>& packing, double threshold, const SurfaceSettings& settings) {
    FreeSurface surface;
    surface.xi.resize(grid.columns);
    surface.eta.assign(grid.columns, not_known);
    std::size_t first = grid.columns, last = 0;
    for (std::size_t c = 0; c < grid.columns; ++c) {
        const double xi = surface.xi[c] = grid.centre_a(c);
        const double reach = std::sqrt(std::max(0.0, settings.drum_radius * settings.drum_radius - xi * xi));
        double outer = not_known;  // packing fraction of the row above
        for (std::size_t r = grid.rows; r-- > 0;) {
            const double here = packing[r * grid.columns + c];
            if (!std::isfinite(here)) continue;
            if (here >= threshold) {
                const double eta = grid.centre_b(r);
                const double crossing = std::isfinite(outer) ? eta + grid.step_b * (here - threshold) / (here - outer) : reach;
                if (crossing + reach >= 0.5 * settings.pellet_diameter) {
                    surface.eta[c] = std::min(crossing, reach);
                    first = std::min(first, c);
                    last = c;
                }
                break;
            }
            outer = here;
        }
    }
    if (first < grid.columns) {
        surface.begin = surface.xi[first] - 0.5 * grid.step_a;
        surface.end = surface.xi[last] + 0.5 * grid.step_a;
    }
    return surface;
}

std::vector<double> surface_height(const FreeSurface& surface, const ChordFrame& chord, const std::vector<double>& x) {
    std::vector<double> height(x.size(), not_known);
    for (std::size_t k = 0; k + 1 < surface.xi.size(); ++k) {
        if (!std::isfinite(surface.eta[k]) || !std::isfinite(surface.eta[k + 1])) continue;
        const Vec2 p = chord.to_world(surface.xi[k], surface.eta[k]), q = chord.to_world(surface.xi[k + 1], surface.eta[k + 1]);
        for (std::size_t i = 0; i < x.size(); ++i) {
            if ((x[i] - p.a) * (x[i] - q.a) > 0.0 || p.a == q.a) continue;
            const double z = p.b + (q.b - p.b) * (x[i] - p.a) / (q.a - p.a);
            if (!(height[i] >= z)) height[i] = z;
        }
    }
    return height;
}

SurfaceFigures surface_figures(const FreeSurface& surface, const ChordFrame& chord) {
    const double length = surface.end - surface.begin;
    const auto angle_between = [&](double from, double to) {
        std::vector<double> xi, eta;
        for (std::size_t k = 0; k < surface.xi.size(); ++k) {
            const double share = (surface.xi[k] - surface.begin) / length;
            if (share < from || share > to) continue;
            xi.push_back(surface.xi[k]);
            eta.push_back(surface.eta[k]);
        }
        return world_angle(fit_line(xi, eta).slope, chord);
    };
    SurfaceFigures figures{not_known, not_known, not_known, not_known};
    if (!(length > 0.0)) return figures;
    figures.upper_angle = angle_between(upper_begin, upper_end);
    figures.lower_angle = angle_between(lower_begin, lower_end);
    figures.whole_angle = angle_between(upper_begin, lower_end);
    figures.highest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < surface.xi.size(); ++k)
        if (std::isfinite(surface.eta[k])) figures.highest = std::max(figures.highest, chord.to_world(surface.xi[k], surface.eta[k]).b);
    return figures;
}

}  // namespace pelletlab::observables::detail
