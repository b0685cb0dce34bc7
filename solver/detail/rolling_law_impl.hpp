// Rolling friction, types A, B and C of Ai, Chen, Rotter & Ooi 2011 (Powder Technology 206:269). Included by kernel files only.
#pragma once

#include "solver/detail/contact_law_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

template <class V>
struct RollingResult {
    Triple<V> moment;  ///< on j
    Triple<V> torque;  ///< [N m], of the rolling spring, to be remembered
    V stiffness;       ///< k_r [N m]
};

/// Type A, constant torque on the relative spin: M = −μ_r R* F_n ω/|ω|, and never more than c.inertia |ω| / Δt, so that all contacts of a body
/// together cannot turn its spin round within one step: near rest the law becomes viscous instead of chattering.
struct RollingConstantTorque {
    static constexpr bool remembers = false;
    template <class L, class V = typename L::Real>
    static Triple<V> moment(const LawRow& law, const ContactState<V>& c, V normal_force, double step) {
        const V zero = L::all(0.0);
        const V torque = L::all(law.rolling_friction) * c.radius * L::larger(normal_force, zero);
        const V spin = L::larger(L::square_root(dot(c.spin, c.spin)), L::all(1e-200));
        const V rate = L::smaller(torque / spin, c.inertia * L::all(1.0 / step));
        return c.spin * (zero - rate);
    }
};

/// Type B, viscous (Zhou et al. 1999): M = −μ_r R* F_n (R* |ω| / 1 m/s) ω/|ω|, with the same bound.
struct RollingViscous {
    static constexpr bool remembers = false;
    template <class L, class V = typename L::Real>
    static Triple<V> moment(const LawRow& law, const ContactState<V>& c, V normal_force, double step) {
        const V zero = L::all(0.0);
        const V rate = L::all(law.rolling_friction) * c.radius * c.radius * L::larger(normal_force, zero);
        return c.spin * (zero - L::smaller(rate, c.inertia * L::all(1.0 / step)));
    }
};

/// Type C, elastic–plastic spring–dashpot on the spin ω_t across the normal:
///   T ← T − k_r ω_t Δt,  |T| ≤ M_m = μ_r R* F_n,  k_r = 2.25 k μ_r² R*²,  k = F_elastic / overlap
///   M = T − C_r ω_t (f C_r once |T| = M_m),  C_r = 2 η_r sqrt(I_r k_r)
/// I_r = J + m* ρ², J the reduced moment of inertia, ρ the sphere's radius at a wall and the mean radius of two spheres: the reduced moment about the contact
/// point, exact for a sphere on a wall and for two equal spheres.
struct RollingElasticPlastic {
    static constexpr bool remembers = true;
    template <class L, class V = typename L::Real>
    static RollingResult<V> moment(const LawRow& law, const ContactState<V>& c, const V& normal_force, const V& secant, const V& arm, const Triple<V>& old,
                                   double spring_step) {
        const V zero = L::all(0.0);
        const Triple<V> spin = c.spin - c.normal * dot(c.spin, c.normal);
        const V stiffness = L::all(law.rolling_stiffness) * secant * c.radius * c.radius;
        const V largest = L::all(law.rolling_friction) * c.radius * L::larger(normal_force, zero);
        Triple<V> torque = old - spin * (stiffness * L::all(spring_step));
        const V size = L::square_root(dot(torque, torque));
        const auto full = L::greater(size, largest);
        torque = torque * L::choose(full, largest / L::choose(full, size, L::all(1.0)), L::all(1.0));
        const V inertia = c.inertia + c.mass * arm * arm;
        const V damping = L::choose(full, L::all(law.rolling_damping_full), L::all(law.rolling_damping)) * L::square_root(inertia * stiffness);
        return {torque - spin * damping, torque, stiffness};
    }
};

}  // namespace
}  // namespace pelletlab::solver::detail
