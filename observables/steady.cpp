#include "observables/steady.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables {

namespace {

constexpr std::size_t fewest_values = 20, fewest_left = 5, copies = 100;
constexpr double moved = 1e-6;  // [rad] or [m], a wall that moved

/// The cut of the marginal standard error rule, from sums that run from the end.
std::size_t best_cut(std::span<const double> y) {
    const std::size_t n = y.size();
    double sum = 0.0, squares = 0.0, best = 0.0;
    const double shift = y.back();  // keeps the sums of squares small
    std::size_t cut = n - fewest_left;
    for (std::size_t d = n; d-- > 0;) {
        const double value = y[d] - shift, left = static_cast<double>(n - d);
        sum += value;
        squares += value * value;
        if (n - d < fewest_left) continue;
        const double statistic = std::max(0.0, squares - sum * sum / left) / (left * left);
        if (n - d == fewest_left || statistic <= best) {
            best = statistic;
            cut = d;
        }
    }
    return cut;
}

std::vector<double> course_of(std::span<const double> y, std::size_t cut) {
    std::vector<double> course(y.begin(), y.end());
    const double level = mean_of(y.subspan(cut));
    std::fill(course.begin() + static_cast<std::ptrdiff_t>(cut), course.end(), level);
    for (std::size_t k = 0; k < cut; ++k) {
        const std::size_t begin = k >= 2 ? k - 2 : 0, end = std::min(k + 3, cut);
        course[k] = mean_of(y.subspan(begin, end - begin));
    }
    return course;
}

double shape_volume(const TrajectoryHeader& header, std::size_t body) {
    return header.shapes[header.shape_of_body[body]].rigid.mass_properties.volume;
}

bool walls_moved(const Frame& first, const Frame& now) {
    for (std::size_t w = 0; w < std::min(first.wall_poses.size(), now.wall_poses.size()); ++w)
        if (first.wall_poses[w].orientation.angularDistance(now.wall_poses[w].orientation) > moved ||
            (first.wall_poses[w].position - now.wall_poses[w].position).norm() > moved)
            return true;
    return false;
}

/// Values at n even steps between the first and the last time, linear in between.
std::vector<double> evenly(const std::vector<double>& time, const std::vector<double>& value, std::size_t n) {
    std::vector<double> even;
    std::size_t k = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double t = time.front() + (time.back() - time.front()) * static_cast<double>(i) / static_cast<double>(n - 1);
        while (k + 2 < time.size() && time[k + 1] < t) ++k;
        even.push_back(value[k] + (value[k + 1] - value[k]) * (t - time[k]) / (time[k + 1] - time[k]));
    }
    return even;
}

}  // namespace

SteadyOnset steady_onset(std::span<const double> series, std::uint64_t seed) {
    SteadyOnset onset;
    const std::size_t n = series.size();
    if (n < fewest_values) return onset;
    const std::size_t cut = best_cut(series);
    onset.index = static_cast<double>(cut);
    onset.found = 2 * cut <= n;
    if (!onset.found) return onset;

    const std::vector<double> course = course_of(series, cut);
    const std::size_t left = n - cut, block = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(left)))));
    double sum = 0.0, squares = 0.0;
    for (std::size_t copy = 0; copy < copies; ++copy) {
        RandomStream random(seed, copy);
        std::vector<double> y = course;
        for (std::size_t k = 0; k < n; k += block) {
            const auto from = cut + static_cast<std::size_t>(random.uniform() * static_cast<double>(left - block + 1));
            for (std::size_t i = 0; i < block && k + i < n; ++i) y[k + i] += series[from + i] - course[from + i];
        }
        const double other = static_cast<double>(best_cut(y));
        sum += other;
        squares += other * other;
    }
    constexpr double c = static_cast<double>(copies);
    onset.standard_error = std::sqrt(std::max(0.0, squares - sum * sum / c) / (c - 1.0));
    return onset;
}

Observable drum_steady_onset(const FrameSource& trajectory) {
    Observable result{"steady_onset_time", "s", not_known, not_known, {}, "drum.steady_onset"};
    const std::size_t count = trajectory.frame_count();
    if (count < 2) return result;
    const TrajectoryHeader& header = trajectory.header();
    const Frame first = trajectory.frame(0);
    const bool walls = !first.wall_poses.empty();
    bool turning = !walls;
    std::vector<double> time, angle;
    for (std::size_t k = 0; k < count; ++k) {
        const Frame frame = trajectory.frame(k);
        if (!turning && walls_moved(first, frame)) turning = true;
        if (walls && !turning) {  // the last frame at rest is the begin of the turning
            time.clear();
            angle.clear();
        }
        double x = 0.0, z = 0.0;
        for (std::size_t body = 0; body < frame.positions.size(); ++body)
            if (frame.is_seen(body)) {
                x += shape_volume(header, body) * frame.positions[body].x();
                z += shape_volume(header, body) * frame.positions[body].z();
            }
        if (x == 0.0 && z == 0.0) continue;
        time.push_back(frame.time);
        angle.push_back(std::atan2(-x, -z));
    }
    if (!turning || time.size() < 2) return result;
    double longest = 0.0;  // the coarsest spacing rules: values in between would be no new ones
    for (std::size_t k = 1; k < time.size(); ++k) longest = std::max(longest, time[k] - time[k - 1]);
    const auto steps = static_cast<std::size_t>(std::floor((time.back() - time.front()) / longest + 1e-6)) + 1;
    result.window = {time.front(), time.back()};
    const SteadyOnset onset = steady_onset(evenly(time, angle, std::max<std::size_t>(2, steps)), header.provenance.seed);
    if (!onset.found) return result;
    const double step = (time.back() - time.front()) / static_cast<double>(steps - 1);
    result.value = time.front() + onset.index * step;
    result.standard_error = std::hypot(onset.standard_error, 0.29) * step;  // a cut lies between two values: 1/√12 of a step
    return result;
}

}  // namespace pelletlab::observables
