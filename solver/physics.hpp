// Which laws a simulation follows: chosen once, when it is made. The defaults are those of the reference study: EDEM's Hertz–Mindlin, constant-torque
// rolling friction, every sphere contact of a clump on its own. Formulas and sources: solver/detail/contact_law_impl.hpp and its neighbours.
#pragma once

#include <cstdint>

namespace pelletlab::solver {

enum class ContactModel : std::uint8_t {
    hertz_edem,           ///< EDEM's Hertz–Mindlin: total tangential displacement, force may pull at the end of a contact
    hertz_impulse_exact,  ///< Hertz–Mindlin that never pulls, damping calibrated so that restitution out = in; incremental tangential spring
    linear,               ///< linear springs and dashpots of constant stiffness
    viscoelastic,         ///< Hertz with the dissipation of viscoelastic spheres (Brilliantov et al. 1996): restitution falls with speed
};

enum class RollingModel : std::uint8_t {
    constant_torque,  ///< type A of Ai et al. 2011
    viscous,          ///< type B
    elastic_plastic,  ///< type C, EPSD
};

enum class Cohesion : std::uint8_t {
    none,
    constant_force,  ///< every contact is pulled together by the same force while it touches
    sjkr,            ///< simplified JKR: energy density × contact area
    jkr,             ///< Johnson, Kendall & Roberts 1971, with its neck beyond touching
    capillary,       ///< liquid bridges after Willett et al. 2000 that break at the distance of Lian et al. 1993
};

enum class ClumpPolicy : std::uint8_t {
    sum,     ///< every sphere contact counts in full, as in EDEM and LIGGGHTS
    shared,  ///< the contacts of two bodies (or of a body and one patch of a wall) act together as one contact
};

/// Liquid that makes bridges (Cohesion::capillary).
struct Liquid {
    double surface_tension = 0.0728;  ///< [N/m]
    double contact_angle = 0.0;       ///< [rad]
    double bridge_volume = 1e-12;     ///< [m³], of every bridge
};

struct Physics {
    ContactModel contact = ContactModel::hertz_edem;
    RollingModel rolling = RollingModel::constant_torque;
    Cohesion cohesion = Cohesion::none;
    ClumpPolicy clump_contacts = ClumpPolicy::sum;
    double linear_stiffness = 1e4;         ///< [N/m], normal, of ContactModel::linear
    double rolling_damping = 0.3;          ///< η_r, share of critical damping, of RollingModel::elastic_plastic
    double rolling_damping_sliding = 0.0;  ///< f, the share of η_r that stays once the full rolling torque is mobilised
    double friction_decay_speed = 0.1;     ///< [m/s], v_c of rate-dependent friction
    Liquid liquid;
    bool energy_book = false;  ///< keep count of elastic energy and of what each mechanism dissipates
};

}  // namespace pelletlab::solver
