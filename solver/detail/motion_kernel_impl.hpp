// The kernels over bodies: drift and gather. Included by kernel files only; the method is described in motion.hpp.
#pragma once

#include "solver/detail/kernels.hpp"
#include "solver/detail/lanes_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

/// Rotation by a vector with |φ|² / 4 ≤ 1/4 [rad]: series to the last bit.
template <class L, class V = typename L::Real>
inline Turn<V> small_rotation(const Triple<V>& phi, const V& h2) {
    const V one = L::all(1.0);
    const auto nest = [&](double divisor, const V& inner) { return one - h2 * L::all(1.0 / divisor) * inner; };
    const V cosine = nest(2.0, nest(12.0, nest(30.0, nest(56.0, nest(90.0, nest(132.0, nest(182.0, one)))))));
    const V sinc = nest(6.0, nest(20.0, nest(42.0, nest(72.0, nest(110.0, nest(156.0, nest(210.0, one)))))));
    const V s = L::all(0.5) * sinc;
    return {cosine, s * phi.x, s * phi.y, s * phi.z};
}

template <class V>
inline V quarter_square(const Triple<V>& phi, const V& quarter) {
    return quarter * dot(phi, phi);
}

/// Any angle: halved until it is small, then squared back.
inline Turn<double> any_rotation(Triple<double> phi) {
    int doublings = 0;
    double h2 = quarter_square(phi, 0.25);
    while (h2 > 0.25 && doublings < 60) {
        phi = phi * 0.5;
        h2 = quarter_square(phi, 0.25);
        ++doublings;
    }
    Turn<double> q = small_rotation<ScalarLanes>(phi, h2);
    for (int k = 0; k < doublings; ++k) q = product(q, q);
    return q;
}

template <class L, class V = typename L::Real>
inline Turn<V> rotation_by(const Triple<V>& phi) {
    const V h2 = quarter_square(phi, L::all(0.25));
    if (L::bits(L::greater(h2, L::all(0.25))) == 0) return small_rotation<L>(phi, h2);
    double x[L::width], y[L::width], z[L::width], w[L::width];
    L::store(x, phi.x), L::store(y, phi.y), L::store(z, phi.z);
    for (std::size_t lane = 0; lane < L::width; ++lane) {
        const Turn<double> q = any_rotation({x[lane], y[lane], z[lane]});
        w[lane] = q.w, x[lane] = q.x, y[lane] = q.y, z[lane] = q.z;
    }
    return {L::load(w), L::load(x), L::load(y), L::load(z)};
}

/// Constants of the templates of a register full of bodies.
template <class L>
struct ConstantLanes {
    using V = typename L::Real;
    V inverse_mass, mass, inverse_transverse, axial_excess, second_excess, offset, inverse_smallest;
    Triple<V> inverse_inertia, axis, second_axis;
};

template <class L>
inline ConstantLanes<L> load_constants(const BodyArrays& b, std::size_t k) {
    const double *first[L::width], *second[L::width];
    for (std::size_t lane = 0; lane < L::width; ++lane) {
        const MotionConstants& c = b.constants[b.template_index[k + lane]];
        first[lane] = c.row;
        second[lane] = c.row + 8;
    }
    typename L::Real r[16];
    L::load_rows(first, r);
    L::load_rows(second, r + 8);
    return {r[0], r[1], r[5], r[6], r[7], r[14], r[15], {r[2], r[3], r[4]}, {r[8], r[9], r[10]}, {r[11], r[12], r[13]}};
}

/// q turned about a body axis by excess · π_axis · Δt, π = Rᵀ L.
template <class L, class V = typename L::Real>
inline Turn<V> turned_about(const Turn<V>& q, const Triple<V>& l, const Triple<V>& axis, const V& excess, double dt) {
    const Triple<V> body = rotate_back(rotation_of<L>(q.w, q.x, q.y, q.z), l);
    return product(q, rotation_by<L>(axis * (excess * dot(axis, body) * L::all(dt))));
}

/// First half kick and drift of bodies [begin, end); both are multiples of `widest` or the end of the padded arrays.
template <class L>
void drift(const BodyArrays& b, std::size_t begin, std::size_t end, const DriftSettings& settings, DriftResult& result) {
    using V = typename L::Real;
    const double dt = settings.step;
    const V half = L::all(0.5 * dt), full = L::all(dt), zero = L::all(0.0);
    V furthest = zero;
    result.first_lost = end;
    for (std::size_t k = begin; k < end; k += L::width) {
        const ConstantLanes<L> c = load_constants<L>(b, k);
        const auto load = [&](auto a) { return Triple<V>{L::load(a[0] + k), L::load(a[1] + k), L::load(a[2] + k)}; };
        const auto store = [&](auto a, const Triple<V>& t) { L::store(a[0] + k, t.x), L::store(a[1] + k, t.y), L::store(a[2] + k, t.z); };
        const Triple<V> push = load(b.force) * (c.inverse_mass * half), twist = load(b.torque) * half;
        const Triple<V> v = load(b.velocity) + push, l = load(b.momentum) + twist;
        store(b.velocity, v);
        store(b.momentum, l);
        const Triple<V> p = load(b.position) + v * full;
        store(b.position, p);
        L::store(b.path + k, L::load(b.path + k) + L::square_root(dot(v, v)) * full);

        Turn<V> q{L::load(b.turn[0] + k), L::load(b.turn[1] + k), L::load(b.turn[2] + k), L::load(b.turn[3] + k)};
        const bool asymmetric = L::bits(L::greater(c.second_excess * c.second_excess, zero)) != 0;
        if (asymmetric) q = turned_about<L>(q, l, c.second_axis, c.second_excess, 0.5 * dt);
        q = turned_about<L>(q, l, c.axis, c.axial_excess, dt);
        q = product(rotation_by<L>(l * (c.inverse_transverse * full)), q);
        if (asymmetric) q = turned_about<L>(q, l, c.second_axis, c.second_excess, 0.5 * dt);
        const V correction = L::all(1.5) - L::all(0.5) * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);  // one Newton step towards length 1
        q = {q.w * correction, q.x * correction, q.y * correction, q.z * correction};
        L::store(b.turn[0] + k, q.w), L::store(b.turn[1] + k, q.x), L::store(b.turn[2] + k, q.y), L::store(b.turn[3] + k, q.z);

        // Velocities of the new instant, predicted with the old force: what the new force is computed from.
        const Triple<V> v_new = v + push, l_new = l + twist;
        const Rotation<V> r = rotation_of<L>(q.w, q.x, q.y, q.z);
        const Triple<V> body = rotate_back(r, l_new);
        const Triple<V> spin = rotate(r, Triple<V>{body.x * c.inverse_inertia.x, body.y * c.inverse_inertia.y, body.z * c.inverse_inertia.z});
        const V place[8] = {p.x, p.y, p.z, q.w, q.x, q.y, q.z, c.offset};
        const V motion[8] = {v_new.x, v_new.y, v_new.z, spin.x, spin.y, spin.z, c.inverse_mass, c.inverse_smallest};
        double *places[L::width], *motions[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) places[lane] = b.records[k + lane].place, motions[lane] = b.records[k + lane].motion;
        L::store_rows(places, place);
        L::store_rows(motions, motion);

        const Triple<V> moved = p - load(b.reference);
        furthest = L::larger(dot(moved, moved), furthest);
        // Written so that a NaN is outside: the number of bounds that hold must be seven.
        const V one = L::all(1.0);
        const auto holds = [&](const V& larger, const V& smaller) { return L::choose(L::greater(larger, smaller), one, zero); };
        const V size = dot(l_new, l_new);
        const V held = holds(p.x, L::all(settings.low[0])) + holds(L::all(settings.high[0]), p.x) + holds(p.y, L::all(settings.low[1])) +
                       holds(L::all(settings.high[1]), p.y) + holds(p.z, L::all(settings.low[2])) + holds(L::all(settings.high[2]), p.z) +
                       holds(L::all(1e300), size);
        const unsigned inside = L::bits(L::greater(held, L::all(6.5)));
        if (inside != (1u << L::width) - 1u)
            for (std::size_t lane = 0; lane < L::width; ++lane)
                if (!((inside >> lane) & 1u) && k + lane < b.count && k + lane < result.first_lost) result.first_lost = k + lane;
    }
    double lanes[L::width];
    L::store(lanes, furthest);
    result.furthest2 = 0.0;
    for (std::size_t lane = 0; lane < L::width; ++lane)
        if (lanes[lane] > result.furthest2) result.furthest2 = lanes[lane];
}

/// Loads of bodies that are summed together: they and the rows they collect fit into the first cache.
inline constexpr std::size_t gathered_bodies = 8 * widest;

/// Adds to sums[body − first] what bodies [first, end) feel from pairs in which they come second, by the order of the list. How many of its pairs touch nobody
/// can foretell of a body, so there is one loop over all, without branches: what touches is picked out and set on its way into the cache, and then added.
template <class L>
inline void add_incoming(const GatherView& g, std::size_t first, std::size_t end, LoadRow* sums) {
    constexpr std::uint32_t piece = 512;
    Incoming picked[piece];
    for (std::uint32_t from = g.incoming_first[first]; from < g.incoming_first[end];) {
        const std::uint32_t to = g.incoming_first[end] - from > piece ? from + piece : g.incoming_first[end];
        std::uint32_t count = 0;
        for (std::uint32_t n = from; n < to; ++n) {
            const Incoming in = g.incoming[n];
            const std::size_t touches = g.touching[in.pair];
            __builtin_prefetch(g.loads_j + in.pair * touches);
            picked[count] = in;
            count += static_cast<std::uint32_t>(touches);
        }
        for (std::uint32_t n = 0; n < count; ++n) add_row<L>(sums[picked[n].body - first].row, g.loads_j[picked[n].pair].row);
        from = to;
    }
}

/// Sums the loads of bodies [first, end), always in this order: pairs in which the body comes first, pairs in which it comes second, walls.
template <class L>
inline void sum_loads(const GatherView& g, std::size_t first, std::size_t end, LoadRow* sums) {
    using V = typename L::Real;
    for (std::size_t i = first; i < end; ++i) {
        const auto counts = L::greater(L::all(static_cast<double>(g.own_touching[i])), L::all(0.0));
        for (std::size_t c = 0; c < 8; c += L::width) {
            const V own = L::load(g.own_loads[i].row + c);
            L::store(sums[i - first].row + c, L::choose(counts, own, L::all(0.0)));
        }
    }
    add_incoming<L>(g, first, end, sums);
    for (std::size_t w = 0; w < g.wall_count; ++w)
        for (std::size_t i = first; i < end; ++i)
            if (g.wall_touching[w][i]) add_row<L>(sums[i - first].row, g.wall_loads[w][i].row);
}

/// Sums gravity, pairs and walls for bodies [begin, end) and gives the second half kick (kick = Δt/2; 0 to look only).
template <class L>
void gather(const BodyArrays& b, const GatherView& g, std::size_t begin, std::size_t end, double kick) {
    using V = typename L::Real;
    LoadRow sums[gathered_bodies];
    for (std::size_t first = begin; first < end; first += gathered_bodies) {
        const std::size_t last = end - first < gathered_bodies ? end : first + gathered_bodies, real = last < b.count ? last : b.count;
        sum_loads<L>(g, first, real, sums);
        for (std::size_t i = real; i < last; ++i) sums[i - first] = LoadRow{};  // of the padding
        for (std::size_t k = first; k < last; k += L::width) {
            const double* rows[L::width];
            for (std::size_t lane = 0; lane < L::width; ++lane) rows[lane] = sums[k - first + lane].row;
            V s[8];
            L::load_rows(rows, s);
            const ConstantLanes<L> c = load_constants<L>(b, k);
            const Triple<V> weight = Triple<V>{L::all(g.gravity[0]), L::all(g.gravity[1]), L::all(g.gravity[2])} * c.mass;
            const Triple<V> f = Triple<V>{s[0], s[1], s[2]} + weight, t{s[3], s[4], s[5]};
            const V push = c.inverse_mass * L::all(kick), twist = L::all(kick);
            const V values[6] = {f.x, f.y, f.z, t.x, t.y, t.z};
            for (int d = 0; d < 3; ++d) {
                L::store(b.force[d] + k, values[d]);
                L::store(b.torque[d] + k, values[3 + d]);
                L::store(b.velocity[d] + k, L::load(b.velocity[d] + k) + values[d] * push);
                L::store(b.momentum[d] + k, L::load(b.momentum[d] + k) + values[3 + d] * twist);
            }
        }
    }
}

}  // namespace
}  // namespace pelletlab::solver::detail
