// Contact laws as small policies, inlined into the kernel. A law turns the state of one contact (or of a register full of them) into force, moment
// and the new tangential displacement. Included by kernel files only.
#pragma once

#include "solver/detail/kernels.hpp"
#include "solver/detail/lanes_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

template <class V>
struct ContactState {
    Triple<V> normal;    ///< from i to j
    V overlap;           ///< [m]
    V radius;            ///< [m], R* = r_i r_j / (r_i + r_j)
    Triple<V> velocity;  ///< [m/s], of j against i at the contact point
    Triple<V> spin;      ///< [rad/s], ω_j − ω_i
    V mass;              ///< [kg], m*
    V inertia;           ///< [kg m²], what rolling friction of this contact may stop in one step
    Triple<V> spring;    ///< [m], total tangential displacement, tangent to the present normal
};

template <class V>
struct ContactResult {
    V normal_force;
    Triple<V> force;   ///< on j
    Triple<V> moment;  ///< on j, rolling friction
    Triple<V> spring;
};

/// Hertz–Mindlin as EDEM states it (help.altair.com/EDEM, "Hertz-Mindlin (no slip)"):
///   S_n = 2 E* sqrt(R* d),  F_n = (2/3) S_n d − c_n v_n,  c_n = −2 sqrt(5/6) β sqrt(S_n m*),  β = ln e / sqrt(ln² e + π²)
///   S_t = 8 G* sqrt(R* d),  F_t = −S_t s − c_t v_t,       c_t = −2 sqrt(5/6) β sqrt(S_t m*),  s the total tangential displacement
///   |F_t| ≤ μ_s max(F_n, 0); where the limit acts, s is cut back so that the spring alone carries it.
/// m* is that of whole bodies. F_n may pull at the end of a contact: that is what gives the wanted restitution.
struct HertzMindlinEdem {
    template <class L, class V = typename L::Real>
    static ContactResult<V> force(const LawRow& law, const ContactState<V>& c) {
        const V zero = L::all(0.0);
        const V stiffness = L::all(law.normal_stiffness) * L::square_root(c.radius * c.overlap);
        const V damping_root = L::square_root(stiffness * c.mass);
        const V normal_speed = dot(c.velocity, c.normal);
        const V normal_force = L::all(2.0 / 3.0) * stiffness * c.overlap - L::all(law.damping) * damping_root * normal_speed;
        const Triple<V> tangential_velocity = c.velocity - c.normal * normal_speed;
        const V tangential_stiffness = L::all(law.tangential_ratio) * stiffness;
        const V tangential_damping = L::all(law.tangential_damping) * damping_root;

        Triple<V> tangential = c.spring * (zero - tangential_stiffness) - tangential_velocity * tangential_damping;
        const V limit = L::all(law.sliding_friction) * L::larger(normal_force, zero);
        const V size = L::square_root(dot(tangential, tangential));
        const auto slides = L::greater(size, limit);
        const V scale = L::choose(slides, limit / L::choose(slides, size, L::all(1.0)), L::all(1.0));
        tangential = tangential * scale;
        const V compliance = L::all(-1.0) / tangential_stiffness;
        ContactResult<V> result;
        result.normal_force = normal_force;
        result.force = c.normal * normal_force + tangential;
        result.spring.x = L::choose(slides, tangential.x * compliance, c.spring.x);
        result.spring.y = L::choose(slides, tangential.y * compliance, c.spring.y);
        result.spring.z = L::choose(slides, tangential.z * compliance, c.spring.z);
        return result;
    }
};

/// Constant-torque rolling friction on the relative spin (type A of Ai et al. 2011): M = −μ_r R* F_n ω/|ω|, and never more than
/// c.inertia |ω| / Δt, so that all contacts of a body together cannot turn its spin round within one step: near rest the law becomes viscous
/// instead of chattering.
struct RollingConstantTorque {
    template <class L, class V = typename L::Real>
    static Triple<V> moment(const LawRow& law, const ContactState<V>& c, V normal_force, double step) {
        const V zero = L::all(0.0);
        const V torque = L::all(law.rolling_friction) * c.radius * L::larger(normal_force, zero);
        const V spin = L::larger(L::square_root(dot(c.spin, c.spin)), L::all(1e-200));
        const V rate = L::smaller(torque / spin, c.inertia * L::all(1.0 / step));
        return c.spin * (zero - rate);
    }
};

/// The old displacement turned into the present tangent plane (length kept) and turned about the normal with the mean spin of the two bodies, then
/// grown by the tangential velocity. The frame turns with i, so the mean spin seen in it is half the relative spin.
template <class L, class V = typename L::Real>
inline Triple<V> carry_spring(const Triple<V>& old, const Triple<V>& normal, const Triple<V>& velocity, const Triple<V>& spin, double spring_step) {
    const V before = dot(old, old);
    Triple<V> spring = old - normal * dot(old, normal);
    const V after = dot(spring, spring);
    const auto keeps = L::greater(after, L::all(0.0));
    spring = spring * L::choose(keeps, L::square_root(before / L::choose(keeps, after, L::all(1.0))), L::all(1.0));
    spring = spring + cross(normal, spring) * (L::all(0.5 * spring_step) * dot(spin, normal));
    const Triple<V> tangential_velocity = velocity - normal * dot(velocity, normal);
    return spring + tangential_velocity * L::all(spring_step);
}

}  // namespace
}  // namespace pelletlab::solver::detail
