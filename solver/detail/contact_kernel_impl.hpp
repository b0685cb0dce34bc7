// The contact kernel over a batch, for any lane type and any law. Included by kernel files only.
#pragma once

#include "solver/detail/contact_law_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

template <class L>
inline Triple<typename L::Real> load_triple(const double* x, const double* y, const double* z, std::size_t k) {
    return {L::load(x + k), L::load(y + k), L::load(z + k)};
}

template <class L>
inline void store_triple(double* x, double* y, double* z, std::size_t k, const Triple<typename L::Real>& a) {
    L::store(x + k, a.x);
    L::store(y + k, a.y);
    L::store(z + k, a.z);
}

template <class L>
struct SlotLanes {
    using V = typename L::Real;
    Triple<V> velocity, spin;
    V mass, inertia;
};

inline SlotLanes<ScalarLanes> load_slots(ScalarLanes, const PairSlot* slots, const std::uint32_t* index) {
    const PairSlot& s = slots[*index];
    return {{s.velocity[0], s.velocity[1], s.velocity[2]}, {s.spin[0], s.spin[1], s.spin[2]}, s.mass, s.inertia};
}

template <class L, class Law, class Rolling>
inline void contact_forces(const LawRow& law, ContactBatch& b, const PairSlot* slots, double spring_step, double step) {
    using V = typename L::Real;
    for (std::size_t k = 0; k < b.size; k += L::width) {
        const SlotLanes<L> pair = load_slots(L{}, slots, b.slot + k);
        const Triple<V> point = load_triple<L>(b.x, b.y, b.z, k);
        ContactState<V> c;
        c.normal = load_triple<L>(b.nx, b.ny, b.nz, k);
        c.overlap = L::load(b.overlap + k);
        c.radius = L::load(b.radius + k);
        c.spin = pair.spin;
        c.velocity = pair.velocity + cross(pair.spin, point);
        c.mass = pair.mass;
        c.inertia = pair.inertia;
        c.spring = carry_spring<L>(load_triple<L>(b.sx, b.sy, b.sz, k), c.normal, c.velocity, c.spin, spring_step);
        const ContactResult<V> result = Law::template force<L>(law, c);
        const Triple<V> moment = Rolling::template moment<L>(law, c, result.normal_force, step) + cross(point, result.force);
        store_triple<L>(b.fx, b.fy, b.fz, k, result.force);
        store_triple<L>(b.mx, b.my, b.mz, k, moment);
        store_triple<L>(b.sx, b.sy, b.sz, k, result.spring);
        L::store(b.normal_force + k, result.normal_force);
    }
}

}  // namespace
}  // namespace pelletlab::solver::detail
