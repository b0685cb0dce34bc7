// The drum seen along its axis, summed over frames: how much pellet volume and momentum falls into each cell of a grid.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/observables.hpp"
#include "observables/detail/pellet_points.hpp"

namespace pelletlab::observables::detail {

/// A point or a velocity of the end view, in one of two frames: (x, z) of the world, or the chord frame (ξ, η).
struct Vec2 {
    double a = 0.0, b = 0.0;
};

/// Chord frame of a bed: origin on the drum's axis, η away from the bed along the line from its centre of mass to the axis, ξ downhill. When the
/// drum turns about −y the world is mirrored first (x → −x), so that the bed climbs at ξ < 0 in any case.
struct ChordFrame {
    double mirror = 1.0;              ///< +1, or −1 for a drum that turns about −y
    double out_x = 0.0, out_z = 1.0;  ///< unit vector of η in the (mirrored) world

    Vec2 to_chord(double x, double z) const { return {out_z * mirror * x - out_x * z, out_x * mirror * x + out_z * z}; }
    Vec2 to_world(double xi, double eta) const { return {mirror * (out_z * xi + out_x * eta), -out_x * xi + out_z * eta}; }
    double inclination() const;  ///< [rad], of the ξ axis below the horizontal
};

/// Sums over cells: volume [m³], volume-weighted velocity components [m³ m/s] and squared speed [m³ m²/s²].
struct CellSums {
    std::vector<double> volume, momentum_a, momentum_b, square;

    CellSums() = default;
    explicit CellSums(std::size_t cells) : volume(cells), momentum_a(cells), momentum_b(cells), square(cells) {}
    void add(const CellSums& other);
};

/// Regular grid over the square that holds the drum; cell (column, row) is centred at first + (column, row)·step.
struct ViewGrid {
    std::size_t columns = 0, rows = 0;
    double first_a = 0.0, first_b = 0.0;  ///< [m], centre of cell (0, 0)
    double step_a = 0.0, step_b = 0.0;    ///< [m]

    static ViewGrid over(double radius, std::size_t columns, std::size_t rows);
    std::size_t cells() const { return columns * rows; }
    double centre_a(std::size_t column) const { return first_a + static_cast<double>(column) * step_a; }
    double centre_b(std::size_t row) const { return first_b + static_cast<double>(row) * step_b; }
    /// False outside the grid.
    bool locate(double a, double b, std::size_t& cell) const;
    /// (cells) share of each cell's area inside the circle of that radius about the origin [m²].
    std::vector<double> area_inside(double radius) const;
};

/// A map over the (x, z) grid in which nothing has been seen yet: values not known, sample counts 0.
FieldMap empty_map(const char* name, const char* unit, const char* method, const ViewGrid& grid, const TimeWindow& window);

/// Which part of the pellets counts, and how much.
struct ViewFilter {
    double y_begin = -std::numeric_limits<double>::infinity();  ///< [m], axial slab: points with y_begin ≤ y < y_end
    double y_end = std::numeric_limits<double>::infinity();
    double pellets_each = 1.0;  ///< pellets that every body stands for: more than 1 when only some of the pellets in the drum were tracked
};

/// What one group of frames adds up to.
struct GroupSums {
    std::size_t frames = 0;
    CellSums chord;
    double solid_volume = 0.0;  ///< [m³], pellet volume that counted, summed over the frames
};

struct EndView {
    ViewGrid chord_grid, map_grid;
    std::vector<GroupSums> groups;  ///< in the order of time
    CellSums map;                   ///< world frame, all groups
};

/// Volume-weighted mean position of the pellets over these frames, world (x, z) [m].
Vec2 mean_position(const FrameSource& trajectory, const std::vector<std::size_t>& frames, const std::vector<PelletPoints>& shapes);

/// Spreads every pellet of every frame over both grids, each of its volume points with its own velocity v + ω × r. `groups` lists the frames of each group.
/// Bodies whose velocity is not known are left out. Frames are read one after the other; groups are summed side by side, with the same bits for any thread
/// count.
EndView collect(const FrameSource& trajectory, const std::vector<std::vector<std::size_t>>& groups, const std::vector<PelletPoints>& shapes,
                const ChordFrame& chord, const ViewGrid& chord_grid, const ViewGrid& map_grid, const ViewFilter& filter);

}  // namespace pelletlab::observables::detail
