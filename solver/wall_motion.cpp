#include "solver/wall_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"

namespace pelletlab::solver {

namespace {

using Numbers = std::array<double, 4>;  ///< shift and angle

Numbers numbers(const MotionRow& row) {
    return {row.shift.x(), row.shift.y(), row.shift.z(), row.angle};
}

/// Slope at row k of a monotone cubic: the harmonic mean of the neighbouring secants, zero where they change sign; at the ends the secant.
double slope_at(const std::vector<MotionRow>& table, std::size_t k, std::size_t which) {
    const auto secant = [&](std::size_t i) { return (numbers(table[i + 1])[which] - numbers(table[i])[which]) / (table[i + 1].time - table[i].time); };
    if (k == 0) return secant(0);
    if (k + 1 == table.size()) return secant(k - 1);
    const double a = secant(k - 1), b = secant(k);
    if (a * b <= 0.0) return 0.0;
    const double before = table[k].time - table[k - 1].time, behind = table[k + 1].time - table[k].time;
    const double w1 = 2.0 * behind + before, w2 = behind + 2.0 * before;
    return (w1 + w2) / (w1 / a + w2 / b);
}

void add_table(const std::vector<MotionRow>& table, double time, WallPlace& place) {
    if (table.empty()) return;
    Numbers value = numbers(table.back()), rate{};
    if (time < table.back().time) {
        const auto above = std::upper_bound(table.begin(), table.end(), time, [](double t, const MotionRow& row) { return t < row.time; });
        const std::size_t k = static_cast<std::size_t>(above - table.begin()) - 1;
        const double h = table[k + 1].time - table[k].time, s = (time - table[k].time) / h;
        for (std::size_t n = 0; n < 4; ++n) {
            const double y0 = numbers(table[k])[n], y1 = numbers(table[k + 1])[n], m0 = h * slope_at(table, k, n), m1 = h * slope_at(table, k + 1, n);
            const double c2 = 3.0 * (y1 - y0) - 2.0 * m0 - m1, c3 = 2.0 * (y0 - y1) + m0 + m1;
            value[n] = y0 + s * (m0 + s * (c2 + s * c3));
            rate[n] = (m0 + s * (2.0 * c2 + 3.0 * s * c3)) / h;
        }
    }
    place.shift += Vec3(value[0], value[1], value[2]);
    place.velocity += Vec3(rate[0], rate[1], rate[2]);
    place.angle += value[3];
    place.angular_speed += rate[3];
}

}  // namespace

WallPlace place_at(const WallMotion& m, double time) {
    WallPlace place{m.velocity * time, m.velocity, m.rotation_speed * time, m.rotation_speed};
    if (m.frequency > 0.0) {
        const double omega = 2.0 * M_PI * m.frequency, argument = omega * time + m.phase;
        const double away = std::sin(argument) - std::sin(m.phase), rate = omega * std::cos(argument);
        place.shift += m.oscillation * away;
        place.velocity += m.oscillation * rate;
        place.angle += m.swing * away;
        place.angular_speed += m.swing * rate;
    }
    add_table(m.table, time, place);
    return place;
}

void check_motion(const WallMotion& m, const std::string& wall) {
    const std::string what = "wall «" + wall + "»: its motion ";
    const bool finite = m.point.allFinite() && m.velocity.allFinite() && m.oscillation.allFinite() && std::isfinite(m.rotation_speed) &&
                        std::isfinite(m.swing) && std::isfinite(m.phase) && std::isfinite(m.frequency) && m.frequency >= 0.0;
    if (!finite || !(std::abs(m.axis.norm() - 1.0) < 1e-9))
        throw bad_input(what + "needs finite numbers and an axis of length 1", "correct the motion of the wall");
    for (std::size_t k = 0; k < m.table.size(); ++k) {
        const MotionRow& row = m.table[k];
        if (!std::isfinite(row.time) || !row.shift.allFinite() || !std::isfinite(row.angle) || (k > 0 && !(row.time > m.table[k - 1].time)))
            throw bad_input(what + "has a table whose row " + std::to_string(k + 1) + " is not finite or not later than the row before it",
                            "sort the rows by time, each time once");
    }
    if (!m.table.empty() && (m.table.size() < 2 || m.table[0].time != 0.0 || m.table[0].shift != Vec3::Zero() || m.table[0].angle != 0.0))
        throw bad_input(what + "has a table that does not begin at time 0 without shift and angle, or has one row only: the wall would jump",
                        "begin the table with a row of zeros");
}

}  // namespace pelletlab::solver
