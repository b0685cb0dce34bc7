// The search for sphere pairs of two bodies that may touch soon. Included by kernel files only.
#pragma once

#include "solver/detail/kernels.hpp"
#include "solver/detail/lanes_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

template <class L>
PELLETLAB_LANES inline double smallest_lane(const typename L::Real& a) {
    double lanes[L::width];
    L::store(lanes, a);
    double least = lanes[0];
    for (std::size_t lane = 1; lane < L::width; ++lane) least = lanes[lane] < least ? lanes[lane] : least;
    return least;
}

template <class L>
PELLETLAB_LANES inline double largest_lane(const typename L::Real& a) {
    return 0.0 - smallest_lane<L>(L::all(0.0) - a);
}

/// Spheres of the second body that face the first, in the frame of the first: into the search's scratch, with a full register of spheres that are nowhere
/// behind them. Returns how low the lowest of all begins along n.
template <class L, class V = typename L::Real>
inline double find_facing(const BallColumns& balls, CandidateSearch& s, const double n[3], double apart, double highest) {
    const double* r = s.turn;
    // n in the frame of the second body tells who faces the first before anything is turned.
    double m[3];
    for (int k = 0; k < 3; ++k) m[k] = r[k] * n[0] + r[3 + k] * n[1] + r[6 + k] * n[2];
    const V mx = L::all(m[0]), my = L::all(m[1]), mz = L::all(m[2]), shift = L::all(apart - 1e-12 * s.extent), bound = L::all(highest + s.reach);
    const Rotation<V> turn{{L::all(r[0]), L::all(r[1]), L::all(r[2])}, {L::all(r[3]), L::all(r[4]), L::all(r[5])}, {L::all(r[6]), L::all(r[7]), L::all(r[8])}};
    const Triple<V> place{L::all(s.place[0]), L::all(s.place[1]), L::all(s.place[2])};
    V lowest = L::all(1e300);
    std::size_t count = 0;
    for (std::size_t b = 0; b < balls.count; b += L::width) {
        const Triple<V> centre{L::load(balls.x + b), L::load(balls.y + b), L::load(balls.z + b)};
        const V radius = L::load(balls.r + b);
        const V low = mx * centre.x + my * centre.y + mz * centre.z + shift - radius;
        const unsigned facing = L::bits(L::greater(bound, low));
        lowest = L::smaller(lowest, low);
        if (facing == 0) continue;
        const Triple<V> c = rotate(turn, centre) + place;
        L::store_chosen(s.x + count, facing, c.x), L::store_chosen(s.y + count, facing, c.y), L::store_chosen(s.z + count, facing, c.z);
        L::store_chosen(s.r + count, facing, radius);
        for (unsigned rest = facing; rest != 0; rest &= rest - 1) s.index[count++] = static_cast<std::uint16_t>(b + static_cast<unsigned>(__builtin_ctz(rest)));
    }
    for (std::size_t k = count; k < count + L::width; ++k) s.x[k] = s.y[k] = s.z[k] = 1e100, s.r[k] = 0.0;
    s.facing = count;
    return smallest_lane<L>(lowest);
}

/// Sphere pairs closer than `skin`, sorted by (a, b). Gaps are looked at up to `reach` > skin. Along the line n between the bodies sphere a ends at
/// top = a · n + r_a and sphere b begins at low = b · n − r_b; their gap is at least low − top, which leaves out all but the spheres that face each other.
template <class L>
bool search_candidates(const BallColumns& first, const BallColumns& second, CandidateSearch& s) {
    using V = typename L::Real;
    s.count = 0;
    s.nearest_other = s.reach;
    const double apart = __builtin_sqrt(s.place[0] * s.place[0] + s.place[1] * s.place[1] + s.place[2] * s.place[2]);
    const double inverse = apart > 0.0 ? 1.0 / apart : 0.0;
    const double n[3] = {s.place[0] * inverse, s.place[1] * inverse, s.place[2] * inverse};
    const Triple<V> along{L::all(n[0]), L::all(n[1]), L::all(n[2])}, place{L::all(s.place[0]), L::all(s.place[1]), L::all(s.place[2])};
    const auto centre_of = [&](std::size_t a) { return Triple<V>{L::load(first.x + a), L::load(first.y + a), L::load(first.z + a)}; };
    V highest = L::all(-1e300);
    for (std::size_t a = 0; a < first.count; a += L::width) highest = L::larger(highest, dot(along, centre_of(a)) + L::load(first.r + a));
    const double top_of_all = largest_lane<L>(highest), low_of_all = find_facing<L>(second, s, n, apart, top_of_all);
    if (s.facing == 0) {  // all of one body is further from all of the other than was asked for
        s.nearest_other = low_of_all - top_of_all - 1e-12 * s.extent;
        return true;
    }
    const V lowest = L::all(low_of_all);
    const V skin = L::all(s.skin), reach = L::all(s.reach), far = L::all(second.bounding_radius + s.reach);
    V nearest = reach;
    for (std::size_t block = 0; block < first.count; block += L::width) {
        const Triple<V> centre = centre_of(block), d = centre - place;
        const V radius = L::load(first.r + block), limit = far + radius;
        const V top = dot(along, centre) + radius;
        unsigned chosen = L::bits(L::greater(top + reach, lowest));
        if (chosen != 0) chosen &= L::bits(L::greater(limit * limit, dot(d, d)));
        for (; chosen != 0; chosen &= chosen - 1) {
            const std::size_t a = block + static_cast<unsigned>(__builtin_ctz(chosen));
            if (s.count + s.facing > s.capacity) return false;
            const Triple<V> sphere{L::all(first.x[a]), L::all(first.y[a]), L::all(first.z[a])};
            const V own = L::all(first.r[a]);
            for (std::size_t k = 0; k < s.facing; k += L::width) {
                const Triple<V> e = Triple<V>{L::load(s.x + k), L::load(s.y + k), L::load(s.z + k)} - sphere;
                const V touch = own + L::load(s.r + k), d2 = dot(e, e);
                const V within = touch + nearest;
                const unsigned near = L::bits(L::greater(within * within, d2));
                if (near == 0) continue;
                const V listed = touch + skin;
                const auto is_listed = L::greater(listed * listed, d2);
                const unsigned candidates = L::bits(is_listed);
                for (unsigned rest = candidates; rest != 0; rest &= rest - 1)
                    s.found[s.count++] = {static_cast<std::uint16_t>(a), s.index[k + static_cast<unsigned>(__builtin_ctz(rest))]};
                if ((near & ~candidates) != 0) {
                    const V gap = L::choose(is_listed, reach, L::square_root(d2) - touch);
                    nearest = L::all(smallest_lane<L>(L::smaller(gap, nearest)));
                }
            }
        }
    }
    s.nearest_other = smallest_lane<L>(nearest);
    return true;
}

}  // namespace
}  // namespace pelletlab::solver::detail
