#include "observables/detail/drum_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "core/error.hpp"
#include "observables/detail/drum_fields.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr std::size_t most_groups = 20;
constexpr std::size_t surface_columns = 80;       // over the drum's diameter
constexpr double rows_per_pellet = 12.0;          // of the occupancy grid, over one equivalent diameter
constexpr double angle_tolerance = 1.0 * degree;  // a drift below this is steady whatever its error
constexpr double height_tolerance = 0.02;         // of the bed height

Stretch stretch_of(GroupSums sums, const Analysis& analysis) {
    Stretch stretch{std::move(sums), {}, {}, 0.0};
    const ViewGrid& grid = analysis.view.chord_grid;
    const auto packing = packing_field(grid, stretch.sums.chord.volume, static_cast<double>(stretch.sums.frames), analysis.settings);
    stretch.surface = free_surface(grid, packing, 0.5 * analysis.bulk, analysis.settings);
    stretch.figures = surface_figures(stretch.surface, analysis.chord);
    stretch.bed_area = area_below(stretch.surface, grid, analysis.settings);
    return stretch;
}

GroupSums sum_of(const std::vector<GroupSums>& groups, std::size_t begin, std::size_t end, std::size_t cells) {
    GroupSums sum{0, CellSums(cells), 0.0};
    for (std::size_t g = begin; g < end; ++g) {
        sum.frames += groups[g].frames;
        sum.solid_volume += groups[g].solid_volume;
        sum.chord.add(groups[g].chord);
    }
    return sum;
}

}  // namespace

Observable Analysis::observable(const std::string& name, const char* unit, double scale, const char* method,
                                const std::function<double(const Stretch&)>& figure) const {
    std::vector<double> series;
    for (const Stretch& group : groups) series.push_back(figure(group) / scale);
    return {name, unit, figure(whole) / scale, standard_error(series), window, method};
}

std::vector<std::size_t> frames_in(const FrameSource& trajectory, const TimeWindow& window) {
    std::vector<std::size_t> frames;
    const double rounding = 1e-9 * std::max(1.0, std::abs(window.end));  // [s]; frame times are sums of time steps
    for (std::size_t k = 0; k < trajectory.frame_count(); ++k) {
        const double time = trajectory.time(k);
        if (time >= window.begin - rounding && time <= window.end + rounding) frames.push_back(k);
    }
    if (frames.empty())
        throw bad_input("the trajectory has no frame between " + std::to_string(window.begin) + " s and " + std::to_string(window.end) + " s",
                        "measure a window that the run covers");
    return frames;
}

std::vector<std::vector<std::size_t>> grouped(const std::vector<std::size_t>& frames) {
    const std::size_t count = std::min(most_groups, frames.size());
    std::vector<std::vector<std::size_t>> groups(count);
    for (std::size_t g = 0; g < count; ++g)
        groups[g].assign(frames.begin() + static_cast<std::ptrdiff_t>(g * frames.size() / count),
                         frames.begin() + static_cast<std::ptrdiff_t>((g + 1) * frames.size() / count));
    return groups;
}

double mean_diameter(const TrajectoryHeader& header, const std::vector<PelletPoints>& shapes) {
    double sum = 0.0;
    for (const std::uint32_t shape : header.shape_of_body) sum += shapes[shape].equivalent_diameter;
    return sum / static_cast<double>(header.shape_of_body.size());
}

ChordFrame chord_frame(const Vec2& centre_of_mass, double rotation_speed) {
    ChordFrame chord;
    chord.mirror = rotation_speed < 0.0 ? -1.0 : 1.0;
    const double distance = std::hypot(centre_of_mass.a, centre_of_mass.b);
    if (distance > 0.0) {
        chord.out_x = -chord.mirror * centre_of_mass.a / distance;
        chord.out_z = -centre_of_mass.b / distance;
    }
    return chord;
}

Analysis analyse_drum(const FrameSource& trajectory, const std::vector<std::size_t>& frames, const std::vector<PelletPoints>& shapes, const DrumGeometry& drum,
                      const ViewFilter& filter) {
    const double diameter = mean_diameter(trajectory.header(), shapes);
    const ChordFrame chord = chord_frame(mean_position(trajectory, frames, shapes), drum.rotation_speed);
    const auto rows = static_cast<std::size_t>(std::ceil(2.0 * drum.radius / diameter * rows_per_pellet));
    const auto map_side = static_cast<std::size_t>(std::ceil(2.0 * drum.radius / drum.velocity_grid));
    const ViewGrid chord_grid = ViewGrid::over(drum.radius, surface_columns, rows);
    const ViewGrid map_grid = ViewGrid::over(0.5 * static_cast<double>(map_side) * drum.velocity_grid, map_side, map_side);
    const double length = std::min(filter.y_end, 0.5 * drum.length) - std::max(filter.y_begin, -0.5 * drum.length);

    Analysis analysis{drum,  {drum.radius, length, diameter},
                      chord, collect(trajectory, grouped(frames), shapes, chord, chord_grid, map_grid, filter),
                      0.0,   {},
                      {},    {trajectory.time(frames.front()), trajectory.time(frames.back())}};
    GroupSums total = sum_of(analysis.view.groups, 0, analysis.view.groups.size(), chord_grid.cells());
    if (!(total.solid_volume > 0.0))
        throw bad_input("no pellet with a known velocity was seen in this part of the drum and this window",
                        "check the window, the axes and the drum's length");
    analysis.bulk = bulk_packing_fraction(chord_grid, total.chord.volume, static_cast<double>(total.frames), analysis.settings);
    analysis.whole = stretch_of(std::move(total), analysis);
    for (const GroupSums& group : analysis.view.groups) analysis.groups.push_back(stretch_of(group, analysis));
    return analysis;
}

/// What moved between the two halves of the window, against the larger of a tolerance and three errors of the difference (three
/// figures are tested, so two errors would call every seventh steady run unsteady).
std::string steadiness(const Analysis& analysis) {
    const std::size_t count = analysis.groups.size();
    if (count < 4) return "complete";  // too few frames to tell; the missing standard errors say so
    const std::size_t cells = analysis.view.chord_grid.cells();
    const Stretch early = stretch_of(sum_of(analysis.view.groups, 0, count / 2, cells), analysis);
    const Stretch late = stretch_of(sum_of(analysis.view.groups, count / 2, count, cells), analysis);
    const auto drifts = [&](const std::function<double(const Stretch&)>& figure, double tolerance) {
        std::vector<double> series;
        for (const Stretch& group : analysis.groups) series.push_back(figure(group));
        // Scatter about each half's own mean: a drift must not hide behind the error that it makes itself.
        const std::span<double> first_half(series.data(), count / 2), second_half(series.data() + count / 2, count - count / 2);
        for (const std::span<double> half : {first_half, second_half}) {
            const double mean = mean_of(half);
            for (double& value : half) value -= mean;
        }
        const double error_of_difference = 2.0 * standard_error(series);  // each half has √2 times the error of the whole
        const double allowed = std::isfinite(error_of_difference) ? std::max(tolerance, 3.0 * error_of_difference) : tolerance;
        return std::abs(figure(late) - figure(early)) > allowed;
    };
    const double bed_height = analysis.whole.figures.highest + analysis.drum.radius;
    const bool drifting = drifts([](const Stretch& s) { return s.figures.upper_angle; }, angle_tolerance) ||
                          drifts([](const Stretch& s) { return s.figures.lower_angle; }, angle_tolerance) ||
                          drifts([](const Stretch& s) { return s.figures.highest; }, height_tolerance * bed_height);
    return drifting ? "not steady" : "complete";
}

}  // namespace pelletlab::observables::detail
