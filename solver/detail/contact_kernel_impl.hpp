// The contact kernel over a batch, for any lane type and any law. Included by kernel files only.
#pragma once

#include "solver/detail/contact_law_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

/// Copies of the last contact behind it: the last register is full, and what it writes twice is the same twice.
inline void pad_batch(ContactBatch& b) {
    double* const columns[8] = {b.dx, b.dy, b.dz, b.ax, b.ay, b.az, b.ra, b.rb};
    const std::size_t last = b.size - 1;
    for (std::size_t k = b.size; k < b.size + widest - 1; ++k) {
        for (double* column : columns) column[k] = column[last];
        b.slot[k] = b.slot[last];
        b.spring[k] = b.spring[last];
    }
}

template <class L>
inline Triple<typename L::Real> load_triple(const double* x, const double* y, const double* z, std::size_t k) {
    return {L::load(x + k), L::load(y + k), L::load(z + k)};
}

template <class L, class Law, class Rolling>
void contact_forces(const LawRow& law, ContactBatch& b, const PairSlot* slots, const StepClock& clock) {
    using V = typename L::Real;
    if (b.size == 0) return;
    pad_batch(b);
    for (std::size_t k = 0; k < b.size; k += L::width) {
        const double* rows[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) rows[lane] = slots[b.slot[k + lane]].row;
        V slot[8];
        L::load_rows(rows, slot);
        const Triple<V> d = load_triple<L>(b.dx, b.dy, b.dz, k), origin = load_triple<L>(b.ax, b.ay, b.az, k);
        const V ra = L::load(b.ra + k), rb = L::load(b.rb + k), reach = ra + rb;
        const V distance = L::square_root(dot(d, d));
        ContactState<V> c;
        c.normal = d * (L::all(1.0) / L::larger(distance, L::all(1e-300)));
        c.overlap = reach - distance;
        // Between spheres the contact point is in the middle of the overlap, on a wall it is the wall's nearest point.
        c.radius = law.wall ? rb : ra * rb / reach;
        const Triple<V> point = law.wall ? origin : origin + c.normal * (ra - L::all(0.5) * c.overlap);
        c.spin = {slot[3], slot[4], slot[5]};
        c.velocity = Triple<V>{slot[0], slot[1], slot[2]} + cross(c.spin, point);
        c.mass = slot[6];
        c.inertia = slot[7];
        double* springs[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) springs[lane] = b.springs[b.spring[k + lane]].row;
        V old[4];
        L::load_short_rows(springs, old);
        c.spring = carry_spring<L>(Triple<V>{old[0], old[1], old[2]}, c.normal, c.velocity, c.spin, clock.spring_step);
        const ContactResult<V> result = Law::template force<L>(law, c);
        const Triple<V> moment = Rolling::template moment<L>(law, c, result.normal_force, clock.step) + cross(point, result.force);
        if (clock.spring_step > 0.0) {
            const V grown[4] = {result.spring.x, result.spring.y, result.spring.z, L::all(0.0)};
            L::store_short_rows(springs, grown);
        }
        const V out[8] = {result.force.x, result.force.y, result.force.z, moment.x, moment.y, moment.z, result.normal_force, L::all(0.0)};
        double* targets[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) targets[lane] = b.result[k + lane].row;
        L::store_rows(targets, out);
    }
}

}  // namespace
}  // namespace pelletlab::solver::detail
