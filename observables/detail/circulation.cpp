#include "observables/detail/circulation.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::observables::detail {

std::vector<double> zero_velocity_line(const CellSums& sums, const FreeSurface& surface, const ViewGrid& grid, double diameter) {
    const auto wide = static_cast<std::ptrdiff_t>(std::lround(0.5 * diameter / grid.step_a)),
               high = static_cast<std::ptrdiff_t>(std::lround(0.25 * diameter / grid.step_b));
    const auto columns = static_cast<std::ptrdiff_t>(grid.columns), rows = static_cast<std::ptrdiff_t>(grid.rows);
    const auto mean = [&](std::ptrdiff_t column, std::ptrdiff_t row) {
        double momentum = 0.0, volume = 0.0;
        for (std::ptrdiff_t r = std::max<std::ptrdiff_t>(0, row - high); r <= std::min(rows - 1, row + high); ++r)
            for (std::ptrdiff_t c = std::max<std::ptrdiff_t>(0, column - wide); c <= std::min(columns - 1, column + wide); ++c) {
                const auto cell = static_cast<std::size_t>(r * columns + c);
                momentum += sums.momentum_a[cell];
                volume += sums.volume[cell];
            }
        return volume > 0.0 ? momentum / volume : not_known;
    };
    std::vector<double> line(grid.columns, not_known);
    for (std::size_t c = 0; c < grid.columns; ++c) {
        if (!std::isfinite(surface.eta[c])) continue;
        double above = not_known;  // the row before
        for (std::size_t r = grid.rows; r-- > 0;) {
            if (grid.centre_b(r) > surface.eta[c]) continue;
            const double here = mean(static_cast<std::ptrdiff_t>(c), static_cast<std::ptrdiff_t>(r));
            if (!std::isfinite(here)) continue;
            if (here <= 0.0) {
                if (above > 0.0) line[c] = grid.centre_b(r) + grid.step_b * here / (here - above);
                break;
            }
            above = here;
        }
    }
    return line;
}

std::vector<Circulation> circulate(const FrameSource& trajectory, const std::vector<std::vector<std::size_t>>& groups, const ChordFrame& chord,
                                   const ViewGrid& grid, const std::vector<double>& line, double diameter, const ViewFilter& filter) {
    enum class State : unsigned char { unknown, active, passive };
    std::vector<State> states(trajectory.header().shape_of_body.size(), State::unknown);
    std::vector<Circulation> result(groups.size());
    const double band = 0.25 * diameter;
    double previous = not_known;
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (const std::size_t index : groups[g]) {
            const Frame frame = trajectory.frame(index);
            const double step = std::isfinite(previous) ? frame.time - previous : 0.0;
            previous = frame.time;
            for (std::size_t body = 0; body < states.size(); ++body) {
                State& state = states[body];
                const Vec3& p = frame.positions[body];
                if (!frame.is_seen(body) || p.y() < filter.y_begin || p.y() >= filter.y_end) {
                    state = State::unknown;
                    continue;
                }
                const Vec2 at = chord.to_chord(p.x(), p.z());
                State now = state;
                std::size_t cell = 0;
                if (grid.locate(at.a, at.b, cell)) {
                    const double edge = line[cell % grid.columns];
                    if (at.b > edge + band) now = State::active;
                    if (at.b < edge - band) now = State::passive;
                }
                // The step is shared evenly when the pellet changed in its course.
                if (state != State::unknown) {
                    (state == State::active ? result[g].active_time : result[g].passive_time) += 0.5 * step;
                    (now == State::active ? result[g].active_time : result[g].passive_time) += 0.5 * step;
                    if (state == State::passive && now == State::active) result[g].into_active += 1.0;
                    if (state == State::active && now == State::passive) result[g].into_passive += 1.0;
                }
                state = now;
            }
        }
    return result;
}

}  // namespace pelletlab::observables::detail
