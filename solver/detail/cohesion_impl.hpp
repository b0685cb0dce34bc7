// Attraction between touching bodies, some of it beyond touching. Included by kernel files only; chosen by a branch that is the same for a whole batch.
#pragma once

#include "solver/detail/contact_law_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

template <class V>
struct CohesiveForce {
    V pull;        ///< [N], ≥ 0 where it attracts: added to the normal force with the other sign
    V limit_gain;  ///< [N], added to the normal force that friction goes by
    V broken;      ///< 1 where the contact has come apart
};

/// Larger root of y⁴ − y = d, found as x = y² from x² − sqrt(x) = d by Newton steps: convex, and the start lies to the right of the root. d ≥ −3/(4·4^(1/3)).
template <class L, class V = typename L::Real>
inline V jkr_root(const V& d) {
    const V smallest = L::all(0.39685026299204984);  // (1/4)^(2/3): the neck that snaps
    V x = L::all(1.0) + L::square_root(L::larger(d, L::all(0.0)));
    for (int k = 0; k < 24; ++k) {
        const V root = L::square_root(x);
        const V slope = L::larger(L::all(2.0) * x - L::all(0.5) / root, L::all(1e-9));
        x = L::larger(x - (x * x - root - d) / slope, smallest);
    }
    return x;
}

inline constexpr double jkr_snap = 0.4724703937105774;  ///< 3 / (4 · 4^(1/3)): −overlap at which a neck snaps, in units of b² / R*

/// constant_force:  F = law.cohesion_strength while the spheres touch
/// sjkr:            F = k A, A = π a², a² = 2 R* d (the circle of intersection, to first order in the overlap)
/// jkr:             a²/R* − sqrt(2 π w a / E*) = d,  F_n = 4 E* a³/(3 R*) − sqrt(8 π w E* a³),  w the work of adhesion; pull-off force (3/2) π w R*;
///                  replaces Hertz's elastic force; friction goes by the first term; the neck snaps where the two roots meet (fixed grips)
/// capillary:       F = 4 π R* γ cos θ / (1 + 1.05 s + 2.5 s²), s = S sqrt(2 R* / V), S the gap (0 when touching): Willett et al. 2000, with the sphere radius
///                  of equal spheres replaced by 2 R*; breaks at S = (1 + θ/2) V^(1/3) (Lian et al. 1993)
/// Contacts begin by touching; a broken one begins again only by touching.
template <class L, class V = typename L::Real>
inline CohesiveForce<V> cohesive_force(const LawRow& law, const ContactState<V>& c, const V& elastic, const V& was_broken) {
    const V zero = L::all(0.0), one = L::all(1.0);
    const auto touches = L::greater(c.overlap, zero);
    if (law.cohesion == Cohesion::constant_force) return {L::choose(touches, L::all(law.cohesion_strength), zero), zero, zero};
    if (law.cohesion == Cohesion::sjkr) return {L::all(law.cohesion_strength) * c.radius * L::larger(c.overlap, zero), zero, zero};
    const V gap = L::larger(zero - c.overlap, zero);
    if (law.cohesion == Cohesion::capillary) {
        const V s = gap * L::square_root(L::all(2.0 / law.bridge_volume) * c.radius);
        const V pull = L::all(law.cohesion_strength) * c.radius / (one + s * (L::all(1.05) + L::all(2.5) * s));
        const V broken = L::choose(touches, zero, L::choose(L::greater(gap, L::all(law.reach)), one, was_broken));
        return {pull * (one - broken), zero, broken};
    }
    // JKR in units of b = (2 π w R*² / E*)^(1/3); law.cohesion_strength = 2 π w / E* [m].
    const V b3 = L::larger(L::all(law.cohesion_strength) * c.radius * c.radius, L::all(1e-60));
    V b = L::square_root(L::square_root(b3 * L::square_root(b3)));  // b3^(3/8): a start for the cube root
    for (int k = 0; k < 20; ++k) b = (L::all(2.0) * b + b3 / (b * b)) * L::all(1.0 / 3.0);
    const V unit = b * b / c.radius;
    const V d = L::larger(c.overlap / unit, L::all(0.0 - jkr_snap));
    const V x = jkr_root<L>(d), root = L::square_root(x);
    // 4 E* b³/(3 R*) x³ − sqrt(8 π w E* b³) x^(3/2), and sqrt(8 π w E* b³) = 2 E* b³ / R*.
    const V scale = L::all(law.half_modulus) * b3 / c.radius;
    const V push = L::all(4.0 / 3.0) * scale * x * x * x, pull = L::all(2.0) * scale * x * root;
    const V broken = L::choose(touches, zero, L::choose(L::greater(gap, L::all(jkr_snap) * unit), one, was_broken));
    const V whole = one - broken;
    return {(elastic - push + pull) * whole, (push - elastic) * whole, broken};
}

}  // namespace
}  // namespace pelletlab::solver::detail
