#include "observables/detail/end_view.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr std::size_t lanes = 4;  // groups summed side by side; fixed, so that the order of every sum is fixed

void deposit(CellSums& sums, std::size_t cell, double volume, const Vec2& velocity, double square) {
    sums.volume[cell] += volume;
    sums.momentum_a[cell] += volume * velocity.a;
    sums.momentum_b[cell] += volume * velocity.b;
    sums.square[cell] += volume * square;
}

void add_frame(const Frame& frame, const TrajectoryHeader& header, const std::vector<PelletPoints>& shapes, const ChordFrame& chord, const ViewGrid& chord_grid,
               const ViewGrid& map_grid, const ViewFilter& filter, GroupSums& group, CellSums& map) {
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        if (!frame.is_tracked(body)) continue;
        const PelletPoints& pellet = shapes[header.shape_of_body[body]];
        const double weight = filter.pellets_each * pellet.volume / static_cast<double>(pellet.points_body.size());
        const Mat3 rotation = frame.orientations[body].toRotationMatrix();
        const Vec3 position = frame.positions[body], velocity = frame.velocities[body], spin = frame.spins[body];
        for (const Vec3& point : pellet.points_body) {
            const Vec3 arm = rotation * point;
            const double y = position.y() + arm.y();
            if (y < filter.y_begin || y >= filter.y_end) continue;
            group.solid_volume += weight;
            const double x = position.x() + arm.x(), z = position.z() + arm.z();
            const double vx = velocity.x() + spin.y() * arm.z() - spin.z() * arm.y();
            const double vz = velocity.z() + spin.x() * arm.y() - spin.y() * arm.x();
            const double square = vx * vx + vz * vz;
            const Vec2 in_chord = chord.to_chord(x, z);
            std::size_t cell = 0;
            if (chord_grid.locate(in_chord.a, in_chord.b, cell)) deposit(group.chord, cell, weight, chord.to_chord(vx, vz), square);
            if (map_grid.locate(x, z, cell)) deposit(map, cell, weight, {vx, vz}, square);
        }
    }
    ++group.frames;
}

}  // namespace

double ChordFrame::inclination() const {
    return std::atan2(out_x, out_z);
}

void CellSums::add(const CellSums& other) {
    for (std::size_t cell = 0; cell < volume.size(); ++cell) {
        volume[cell] += other.volume[cell];
        momentum_a[cell] += other.momentum_a[cell];
        momentum_b[cell] += other.momentum_b[cell];
        square[cell] += other.square[cell];
    }
}

FieldMap empty_map(const char* name, const char* unit, const char* method, const ViewGrid& grid, const TimeWindow& window) {
    FieldMap map;
    map.name = name;
    map.unit = unit;
    map.horizontal_axis = "x";
    map.vertical_axis = "z";
    map.origin_horizontal = grid.first_a;
    map.origin_vertical = grid.first_b;
    map.spacing = grid.step_a;
    map.columns = grid.columns;
    map.rows = grid.rows;
    map.value.assign(grid.cells(), not_known);
    map.sample_count.assign(grid.cells(), 0.0);
    map.window = window;
    map.method = method;
    return map;
}

ViewGrid ViewGrid::over(double radius, std::size_t columns, std::size_t rows) {
    ViewGrid grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.step_a = 2.0 * radius / static_cast<double>(columns);
    grid.step_b = 2.0 * radius / static_cast<double>(rows);
    grid.first_a = -radius + 0.5 * grid.step_a;
    grid.first_b = -radius + 0.5 * grid.step_b;
    return grid;
}

bool ViewGrid::locate(double a, double b, std::size_t& cell) const {
    const double column = std::floor((a - first_a) / step_a + 0.5);
    const double row = std::floor((b - first_b) / step_b + 0.5);
    if (!(column >= 0.0 && row >= 0.0 && column < static_cast<double>(columns) && row < static_cast<double>(rows))) return false;
    cell = static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
    return true;
}

std::vector<double> ViewGrid::area_inside(double radius) const {
    constexpr int strips = 16;
    std::vector<double> area(cells(), 0.0);
    for (std::size_t column = 0; column < columns; ++column)
        for (int strip = 0; strip < strips; ++strip) {
            const double a = centre_a(column) + ((strip + 0.5) / strips - 0.5) * step_a;
            if (std::abs(a) >= radius) continue;
            const double reach = std::sqrt(radius * radius - a * a);
            for (std::size_t row = 0; row < rows; ++row) {
                const double lower = std::max(centre_b(row) - 0.5 * step_b, -reach), upper = std::min(centre_b(row) + 0.5 * step_b, reach);
                area[row * columns + column] += std::max(0.0, upper - lower) * step_a / strips;
            }
        }
    return area;
}

Vec2 mean_position(const FrameSource& trajectory, const std::vector<std::size_t>& frames, const std::vector<PelletPoints>& shapes) {
    const TrajectoryHeader& header = trajectory.header();
    double x = 0.0, z = 0.0, volume = 0.0;
    for (const std::size_t index : frames) {
        const Frame frame = trajectory.frame(index);
        for (std::size_t body = 0; body < frame.positions.size(); ++body) {
            if (!frame.is_seen(body)) continue;
            const double weight = shapes[header.shape_of_body[body]].volume;
            x += weight * frame.positions[body].x();
            z += weight * frame.positions[body].z();
            volume += weight;
        }
    }
    return volume > 0.0 ? Vec2{x / volume, z / volume} : Vec2{};
}

EndView collect(const FrameSource& trajectory, const std::vector<std::vector<std::size_t>>& groups, const std::vector<PelletPoints>& shapes,
                const ChordFrame& chord, const ViewGrid& chord_grid, const ViewGrid& map_grid, const ViewFilter& filter) {
    const TrajectoryHeader& header = trajectory.header();
    EndView view{chord_grid, map_grid, {}, CellSums(map_grid.cells())};
    view.groups.assign(groups.size(), {0, CellSums(chord_grid.cells()), 0.0});
    std::vector<CellSums> maps(lanes, CellSums(map_grid.cells()));
    for (std::size_t first = 0; first < groups.size(); first += lanes) {
        const std::size_t side_by_side = std::min(lanes, groups.size() - first);
        std::size_t longest = 0;
        for (std::size_t lane = 0; lane < side_by_side; ++lane) longest = std::max(longest, groups[first + lane].size());
        for (std::size_t k = 0; k < longest; ++k) {
            std::vector<Frame> frames(side_by_side);  // read in turn: a file cannot be read from two threads
            for (std::size_t lane = 0; lane < side_by_side; ++lane)
                if (k < groups[first + lane].size()) frames[lane] = trajectory.frame(groups[first + lane][k]);
            parallel_for(side_by_side, 1, [&](std::size_t lane) {
                if (k < groups[first + lane].size())
                    add_frame(frames[lane], header, shapes, chord, chord_grid, map_grid, filter, view.groups[first + lane], maps[lane]);
            });
        }
    }
    for (const CellSums& map : maps) view.map.add(map);
    return view;
}

}  // namespace pelletlab::observables::detail
