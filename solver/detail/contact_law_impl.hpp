// Contact laws as small policies, inlined into the kernel. A law turns the state of one contact (or of a register full of them) into force and
// the new tangential displacement. Included by kernel files only.
//
// All laws have the same build:
//   F_n   along the normal: elastic part and damping part, the law's own
//   F_t = −S_t s − c_t v_t, |F_t| ≤ μ max(F_n, 0), s the tangential displacement; where the limit acts, s is cut back so that the spring alone carries it.
// m* is that of whole bodies (or what LawRow and the clump policy make of it). S_n is the normal stiffness at the present overlap, S_t = (4 G*/E*) S_n.
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
    V inertia;           ///< [kg m²], what rolling friction of this contact may stop in one step; with elastic–plastic rolling the reduced moment
    Triple<V> spring;    ///< [m], total tangential displacement, tangent to the present normal
};

template <class V>
struct ContactResult {
    V normal_force;   ///< without cohesion: what friction and rolling friction go by
    Triple<V> force;  ///< on j
    Triple<V> spring;
};

template <class V>
struct NormalForce {
    V stiffness;           ///< S_n [N/m]
    V elastic;             ///< [N]
    V total;               ///< [N], with damping
    V tangential_damping;  ///< c_t [N s/m]
};

/// Hertz–Mindlin as EDEM states it (help.altair.com/EDEM, "Hertz-Mindlin (no slip)"):
///   S_n = 2 E* sqrt(R* d),  F_n = (2/3) S_n d − c_n v_n,  c_n = −2 sqrt(5/6) β sqrt(S_n m*),  β = ln e / sqrt(ln² e + π²)
///   S_t = 8 G* sqrt(R* d),  c_t = −2 sqrt(5/6) β sqrt(S_t m*),  s the total tangential displacement
/// F_n may pull at the end of a contact: that is what gives the wanted restitution.
struct HertzMindlinEdem {
    static constexpr bool hertz = true, incremental = false;
    template <class L, class V = typename L::Real>
    static NormalForce<V> normal(const LawRow& law, const ContactState<V>& c, const V& overlap, const V& normal_speed) {
        const V stiffness = L::all(law.normal_stiffness) * L::square_root(c.radius * overlap);
        const V damping_root = L::square_root(stiffness * c.mass);
        const V elastic = L::all(2.0 / 3.0) * stiffness * overlap;
        return {stiffness, elastic, elastic - L::all(law.damping) * damping_root * normal_speed, L::all(law.tangential_damping) * damping_root};
    }
};

/// Hertz–Mindlin whose impulse is exact: F_n = max(0, (2/3) S_n d − c_n v_n) never pulls, and law.damping is calibrated (materials.cpp) so that a normal
/// impact returns with the wanted restitution nevertheless. The tangential force grows by −S_t v_t Δt and, when the overlap shrinks, shrinks with S_t:
/// the rule that creates no energy (Elata & Berryman 1996).
struct HertzMindlinImpulseExact {
    static constexpr bool hertz = true, incremental = true;
    template <class L, class V = typename L::Real>
    static NormalForce<V> normal(const LawRow& law, const ContactState<V>& c, const V& overlap, const V& normal_speed) {
        NormalForce<V> f = HertzMindlinEdem::normal<L>(law, c, overlap, normal_speed);
        f.total = L::larger(f.total, L::all(0.0));
        return f;
    }
};

/// Linear spring and dashpot (Cundall & Strack 1979): F_n = k_n d − c_n v_n, c_n = −2 β sqrt(k_n m*): restitution e at every speed. May pull at the end.
struct LinearSpringDashpot {
    static constexpr bool hertz = false, incremental = false;
    template <class L, class V = typename L::Real>
    static NormalForce<V> normal(const LawRow& law, const ContactState<V>& c, const V& overlap, const V& normal_speed) {
        const V stiffness = L::all(law.normal_stiffness);
        const V damping_root = L::square_root(stiffness * c.mass);
        const V elastic = stiffness * overlap;
        return {stiffness, elastic, elastic - L::all(law.damping) * damping_root * normal_speed, L::all(law.tangential_damping) * damping_root};
    }
};

/// Viscoelastic spheres (Brilliantov, Spahn, Hertzsch & Pöschel 1996): F_n = max(0, (2/3) S_n d − A S_n v_n), law.damping = A [s], a constant of the material;
/// restitution falls with speed as 1 − C₁ … v^(1/5). The tangential direction has the same relaxation time: c_t = A S_t.
struct Viscoelastic {
    static constexpr bool hertz = true, incremental = false;
    template <class L, class V = typename L::Real>
    static NormalForce<V> normal(const LawRow& law, const ContactState<V>& c, const V& overlap, const V& normal_speed) {
        const V stiffness = L::all(law.normal_stiffness) * L::square_root(c.radius * overlap);
        const V elastic = L::all(2.0 / 3.0) * stiffness * overlap;
        const V total = elastic - L::all(law.damping) * stiffness * normal_speed;
        return {stiffness, elastic, L::larger(total, L::all(0.0)), L::all(law.tangential_damping) * stiffness};
    }
};

/// A vector that belongs to the contact, turned into the present tangent plane (length kept) and turned about the normal with the mean spin of the two
/// bodies. The frame turns with i, so the mean spin seen in it is half the relative spin.
template <class L, class V = typename L::Real>
inline Triple<V> carried(const Triple<V>& old, const Triple<V>& normal, const Triple<V>& spin, double spring_step) {
    const V before = dot(old, old);
    Triple<V> now = old - normal * dot(old, normal);
    const V after = dot(now, now);
    const auto keeps = L::greater(after, L::all(0.0));
    now = now * L::choose(keeps, L::square_root(before / L::choose(keeps, after, L::all(1.0))), L::all(1.0));
    return now + cross(normal, now) * (L::all(0.5 * spring_step) * dot(spin, normal));
}

/// S_n of the last step / S_n now.
template <class Law, class L, class V = typename L::Real>
inline V stiffness_ratio(const V& overlap, const V& last_overlap) {
    if constexpr (!Law::hertz) return L::all(1.0);
    return L::square_root(L::larger(last_overlap, L::all(0.0)) / L::larger(overlap, L::all(1e-300)));
}

/// The displacement that an incremental spring has after its stiffness has changed: force is kept where the contact is loaded, displacement where it is
/// unloaded.
template <class Law, class L, class V = typename L::Real>
inline Triple<V> rescaled(const Triple<V>& spring, const ContactState<V>& c, const V& last_overlap) {
    if constexpr (!Law::incremental) return spring;
    const V ratio = stiffness_ratio<Law, L>(c.overlap, last_overlap);
    return spring * L::smaller(ratio, L::all(1.0));
}

/// Normal force as given, friction limited by `limit_force`.
template <class L, class V = typename L::Real>
inline ContactResult<V> with_friction(const ContactState<V>& c, const NormalForce<V>& normal, const V& tangential_ratio, const V& limit,
                                      const Triple<V>& tangential_velocity) {
    const V zero = L::all(0.0);
    const V tangential_stiffness = tangential_ratio * normal.stiffness;
    Triple<V> tangential = c.spring * (zero - tangential_stiffness) - tangential_velocity * normal.tangential_damping;
    const V size = L::square_root(dot(tangential, tangential));
    const auto slides = L::greater(size, limit);
    const V scale = L::choose(slides, limit / L::choose(slides, size, L::all(1.0)), L::all(1.0));
    tangential = tangential * scale;
    const V compliance = L::all(-1.0) / tangential_stiffness;
    ContactResult<V> result;
    result.normal_force = normal.total;
    result.force = c.normal * normal.total + tangential;
    result.spring.x = L::choose(slides, tangential.x * compliance, c.spring.x);
    result.spring.y = L::choose(slides, tangential.y * compliance, c.spring.y);
    result.spring.z = L::choose(slides, tangential.z * compliance, c.spring.z);
    return result;
}

}  // namespace
}  // namespace pelletlab::solver::detail
