#include "observables/detail/drum_fields.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace pelletlab::observables::detail {

namespace {

/// Calls visit(cell, ξ, η, depth below the surface) for every cell under the surface.
template <class Visit>
void for_each_below(const FreeSurface& surface, const ViewGrid& grid, const Visit& visit) {
    for (std::size_t c = 0; c < grid.columns; ++c) {
        if (!std::isfinite(surface.eta[c])) continue;
        for (std::size_t r = 0; r < grid.rows; ++r) {
            const double depth = surface.eta[c] - grid.centre_b(r);
            if (depth >= 0.0) visit(r * grid.columns + c, grid.centre_a(c), grid.centre_b(r), depth);
        }
    }
}

bool in_middle_fifth(const FreeSurface& surface, double xi) {
    const double share = (xi - surface.begin) / (surface.end - surface.begin);
    return share >= 0.4 && share <= 0.6;
}

double ratio(double momentum, double volume) {
    return volume > 0.0 ? momentum / volume : not_known;
}

}  // namespace

double area_below(const FreeSurface& surface, const ViewGrid& grid, const SurfaceSettings& settings) {
    double area = 0.0;
    for (std::size_t c = 0; c < grid.columns; ++c) {
        if (!std::isfinite(surface.eta[c])) continue;
        const double xi = grid.centre_a(c);
        area += (surface.eta[c] + std::sqrt(std::max(0.0, settings.drum_radius * settings.drum_radius - xi * xi))) * grid.step_a;
    }
    return area;
}

std::vector<double> surface_velocity(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double layer) {
    std::vector<double> momentum(grid.columns, 0.0), volume(grid.columns, 0.0);
    for_each_below(surface, grid, [&](std::size_t cell, double, double, double depth) {
        if (depth > layer) return;
        momentum[cell % grid.columns] += sums.momentum_a[cell];
        volume[cell % grid.columns] += sums.volume[cell];
    });
    for (std::size_t c = 0; c < grid.columns; ++c) momentum[c] = ratio(momentum[c], volume[c]);
    return momentum;
}

double middle_surface_velocity(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double layer) {
    double momentum = 0.0, volume = 0.0;
    for_each_below(surface, grid, [&](std::size_t cell, double xi, double, double depth) {
        if (depth > layer || !in_middle_fifth(surface, xi)) return;
        momentum += sums.momentum_a[cell];
        volume += sums.volume[cell];
    });
    return ratio(momentum, volume);
}

std::vector<double> depth_velocity(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double bin, std::size_t bins) {
    std::vector<double> momentum(bins, 0.0), volume(bins, 0.0);
    for_each_below(surface, grid, [&](std::size_t cell, double xi, double, double depth) {
        const auto k = static_cast<std::size_t>(depth / bin);
        if (k >= bins || !in_middle_fifth(surface, xi)) return;
        momentum[k] += sums.momentum_a[cell];
        volume[k] += sums.volume[cell];
    });
    for (std::size_t k = 0; k < bins; ++k) momentum[k] = ratio(momentum[k], volume[k]);
    return momentum;
}

double rigid_layer_rotation(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, const SurfaceSettings& settings) {
    double angular_momentum = 0.0, inertia = 0.0;
    for_each_below(surface, grid, [&](std::size_t cell, double xi, double eta, double depth) {
        const double r = std::hypot(xi, eta);
        if (depth < 2.0 * settings.pellet_diameter || r > settings.drum_radius || r < settings.drum_radius - 2.0 * settings.pellet_diameter) return;
        // Rotation about +y: v = Ω (z, −x), in the chord frame Ω (η, −ξ).
        angular_momentum += sums.momentum_a[cell] * eta - sums.momentum_b[cell] * xi;
        inertia += sums.volume[cell] * r * r;
    });
    return ratio(angular_momentum, inertia);
}

std::vector<FieldMap> end_view_maps(const CellSums& sums, const ViewGrid& grid, const MapSettings& settings) {
    FieldMap vx = empty_map("vx", "m/s", "drum.velocity_map", grid, settings.window), vz = empty_map("vz", "m/s", "drum.velocity_map", grid, settings.window);
    FieldMap speed = empty_map("speed", "m/s", "drum.velocity_map", grid, settings.window);
    FieldMap fluctuation = empty_map("velocity_fluctuation", "m/s", "drum.velocity_fluctuation", grid, settings.window);
    FieldMap packing = empty_map("packing_fraction", "1", "drum.packing_map", grid, settings.window);
    const std::vector<double> area = grid.area_inside(settings.drum_radius);
    const double full_cell = grid.step_a * grid.step_b;
    for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
        const double volume = sums.volume[cell], seen = volume / settings.pellet_volume;
        for (FieldMap* map : {&vx, &vz, &speed, &fluctuation, &packing}) map->sample_count[cell] = seen;
        if (area[cell] >= 0.25 * full_cell) packing.value[cell] = volume / (area[cell] * settings.drum_length * settings.frames);
        if (seen < 1.0) continue;
        vx.value[cell] = sums.momentum_a[cell] / volume;
        vz.value[cell] = sums.momentum_b[cell] / volume;
        speed.value[cell] = std::hypot(vx.value[cell], vz.value[cell]);
        fluctuation.value[cell] = std::sqrt(std::max(0.0, sums.square[cell] / volume - speed.value[cell] * speed.value[cell]));
    }
    return {std::move(speed), std::move(vx), std::move(vz), std::move(fluctuation), std::move(packing)};
}

}  // namespace pelletlab::observables::detail
