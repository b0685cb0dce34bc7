#include "io/detail/track_rates.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::io::detail {

namespace {

Vec3 rotation_vector(const Quat& from, const Quat& to) {
    Quat turn = to * from.conjugate();
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();  // the shorter way
    const double sine = turn.vec().norm();
    if (!(sine > 0.0)) return Vec3::Zero();
    return turn.vec() * (2.0 * std::atan2(sine, turn.w()) / sine);
}

Vec3 velocity_between(const TrackedRow* before, const TrackedRow& now, const TrackedRow* after) {
    if (before != nullptr && after != nullptr) {
        const double h1 = now.time - before->time, h2 = after->time - now.time;
        return ((after->position - now.position) * (h1 * h1) + (now.position - before->position) * (h2 * h2)) / (h1 * h2 * (h1 + h2));
    }
    if (after != nullptr) return (after->position - now.position) / (after->time - now.time);
    if (before != nullptr) return (now.position - before->position) / (now.time - before->time);
    return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
}

Vec3 spin_between(const TrackedRow* before, const TrackedRow& now, const TrackedRow* after) {
    const TrackedRow& from = before != nullptr ? *before : now;
    const TrackedRow& to = after != nullptr ? *after : now;
    if (&from == &to) return Vec3::Zero();
    return rotation_vector(from.orientation, to.orientation) / (to.time - from.time);
}

}  // namespace

RateCounts add_rates(std::vector<TrackedRow>& rows, std::size_t bodies, const RateSettings& settings) {
    std::vector<std::vector<std::size_t>> tracks(bodies);
    for (std::size_t k = 0; k < rows.size(); ++k) tracks[rows[k].body].push_back(k);
    std::vector<double> steps;
    for (const auto& track : tracks)
        for (std::size_t k = 1; k < track.size(); ++k) steps.push_back(rows[track[k]].time - rows[track[k - 1]].time);
    double usual = 0.0;
    if (!steps.empty()) {
        const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
        std::nth_element(steps.begin(), middle, steps.end());
        usual = *middle;
    }
    const double largest = settings.largest_gap > 0.0 ? settings.largest_gap : 2.5 * usual;

    RateCounts counts;
    for (const auto& track : tracks)
        for (std::size_t k = 0; k < track.size(); ++k) {
            TrackedRow& now = rows[track[k]];
            const TrackedRow* before = k > 0 ? &rows[track[k - 1]] : nullptr;
            const TrackedRow* after = k + 1 < track.size() ? &rows[track[k + 1]] : nullptr;
            if (before != nullptr && usual > 0.0)
                counts.missing += static_cast<std::size_t>(std::max(0.0, std::round((now.time - before->time) / usual) - 1.0));
            if (before != nullptr && now.time - before->time > largest) before = nullptr;
            if (after != nullptr && after->time - now.time > largest) after = nullptr;
            if (settings.velocities) now.velocity = velocity_between(before, now, after);
            if (settings.spins) now.spin = spin_between(before, now, after);
            if (!now.velocity.allFinite()) ++counts.without_velocity;
        }
    return counts;
}

}  // namespace pelletlab::io::detail
