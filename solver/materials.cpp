#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "solver/detail/damping_calibration.hpp"
#include "solver/detail/state.hpp"

namespace pelletlab::solver::detail {

namespace {

constexpr double smallest_restitution = 0.01;  ///< that a contact without tension is calibrated for

void check_range(bool good, const std::string& what, const std::string& quantity, const std::string& range) {
    if (!good) throw bad_input(what + ": " + quantity + " must be " + range, "correct it in the material or contact table");
}

bool zero_or_more(double x) {
    return x >= 0.0 && std::isfinite(x);
}

void check_contact(const PairParameters& contact, const Physics& physics, const std::string& what) {
    check_range(contact.restitution >= 0.0 && contact.restitution <= 1.0, what, "the restitution", "in [0, 1]");
    check_range(physics.contact != ContactModel::hertz_impulse_exact || contact.restitution >= smallest_restitution, what,
                "the restitution of hertz_impulse_exact", "at least 0.01");
    check_range(zero_or_more(contact.sliding_friction), what, "the sliding friction", "zero or positive");
    check_range(zero_or_more(contact.rolling_friction), what, "the rolling friction", "zero or positive");
    check_range(contact.kinetic_friction_ratio >= 0.0 && contact.kinetic_friction_ratio <= 1.0, what, "the ratio of kinetic to static friction", "in [0, 1]");
    check_range(zero_or_more(contact.relaxation_time), what, "the relaxation time", "zero or positive");
    check_range(zero_or_more(contact.attraction_force), what, "the attraction force", "zero or positive");
    check_range(zero_or_more(contact.cohesion_energy_density), what, "the cohesion energy density", "zero or positive");
    check_range(zero_or_more(contact.work_of_adhesion), what, "the work of adhesion", "zero or positive");
}

/// −β = −ln e / sqrt(ln² e + π²); 1 in the limit e → 0.
double damping_ratio(double restitution) {
    if (restitution <= 0.0) return 1.0;
    const double log_e = std::log(restitution);
    return -log_e / std::sqrt(log_e * log_e + M_PI * M_PI);
}

void set_damping(LawRow& row, const PairParameters& contact, const Physics& physics) {
    const double ratio = damping_ratio(contact.restitution), root = std::sqrt(row.tangential_ratio);
    row.damping = 2.0 * std::sqrt(5.0 / 6.0) * ratio;
    if (physics.contact == ContactModel::linear) row.damping = 2.0 * ratio;
    row.tangential_damping = row.damping * root;
    // α sqrt(m* k) d^(1/4) = α sqrt(2/3) sqrt(S_n m*)
    if (physics.contact == ContactModel::hertz_impulse_exact) row.damping = damping_without_tension(contact.restitution) * std::sqrt(2.0 / 3.0);
    if (physics.contact == ContactModel::viscoelastic) {
        row.damping = contact.relaxation_time;
        row.tangential_damping = contact.relaxation_time * row.tangential_ratio;
    }
}

void set_cohesion(LawRow& row, double e_star, const PairParameters& contact, const Physics& physics, double largest_radius) {
    switch (physics.cohesion) {
        case Cohesion::none:
            return;
        case Cohesion::constant_force:
            row.cohesion_strength = contact.attraction_force;
            break;
        case Cohesion::sjkr:
            row.cohesion_strength = 2.0 * M_PI * contact.cohesion_energy_density;
            break;
        case Cohesion::jkr: {
            row.cohesion_strength = 2.0 * M_PI * contact.work_of_adhesion / e_star;
            row.half_modulus = e_star;
            const double r = largest_radius, b = std::cbrt(row.cohesion_strength * r * r);
            if (row.cohesion_strength > 0.0) row.reach = 0.4724703937105775 * b * b / r;
            break;
        }
        case Cohesion::capillary: {
            const Liquid& l = physics.liquid;
            row.cohesion_strength = 4.0 * M_PI * l.surface_tension * std::cos(l.contact_angle);
            row.bridge_volume = l.bridge_volume;
            row.reach = (1.0 + 0.5 * l.contact_angle) * std::cbrt(l.bridge_volume);
            break;
        }
    }
    if (row.cohesion_strength > 0.0) row.cohesion = physics.cohesion;
}

}  // namespace

void check_physics(const Physics& p) {
    check_range(p.linear_stiffness > 0.0 && std::isfinite(p.linear_stiffness), "physics", "the linear stiffness", "positive");
    check_range(zero_or_more(p.rolling_damping), "physics", "the rolling damping", "zero or positive");
    check_range(zero_or_more(p.rolling_damping_sliding), "physics", "the share of rolling damping that stays at full torque", "zero or positive");
    check_range(p.friction_decay_speed > 0.0 && std::isfinite(p.friction_decay_speed), "physics", "the decay speed of friction", "positive");
    check_range(zero_or_more(p.liquid.surface_tension), "physics", "the surface tension", "zero or positive");
    check_range(p.liquid.contact_angle >= 0.0 && p.liquid.contact_angle < 0.5 * M_PI, "physics", "the contact angle", "in [0, 90) degrees");
    check_range(p.liquid.bridge_volume > 0.0 && std::isfinite(p.liquid.bridge_volume), "physics", "the bridge volume", "positive");
    if (p.cohesion == Cohesion::jkr && p.contact == ContactModel::linear)
        throw bad_input("JKR cohesion needs a Hertz contact: the linear law has no contact area", "choose another contact model, or sjkr");
    if (p.clump_contacts == ClumpPolicy::shared && p.cohesion == Cohesion::jkr)
        throw bad_input("the contacts of a clump cannot share a JKR neck", "choose clump contacts «sum», or another cohesion");
}

LawRow make_law_row(const ElasticMaterial& a, const ElasticMaterial& b, const PairParameters& contact, const Physics& physics, double largest_radius,
                    const std::string& what) {
    for (const ElasticMaterial& m : {a, b}) {
        check_range(m.shear_modulus > 0.0 && std::isfinite(m.shear_modulus), what, "the shear modulus", "positive");
        check_range(m.poisson_ratio > -1.0 && m.poisson_ratio <= 0.5, what, "Poisson's ratio", "in (-1, 0.5]");
    }
    check_contact(contact, physics, what);
    const auto plane_compliance = [](const ElasticMaterial& m) { return (1.0 - m.poisson_ratio) / (2.0 * m.shear_modulus); };  // (1 − ν²)/E, E = 2 G (1 + ν)
    const auto shear_compliance = [](const ElasticMaterial& m) { return (2.0 - m.poisson_ratio) / m.shear_modulus; };
    const double e_star = 1.0 / (plane_compliance(a) + plane_compliance(b));
    const double g_star = 1.0 / (shear_compliance(a) + shear_compliance(b));
    LawRow row;
    row.normal_stiffness = physics.contact == ContactModel::linear ? physics.linear_stiffness : 2.0 * e_star;
    row.tangential_ratio = 4.0 * g_star / e_star;
    set_damping(row, contact, physics);
    row.sliding_friction = contact.sliding_friction;
    row.rolling_friction = contact.rolling_friction;
    row.friction_drop = contact.sliding_friction * (1.0 - contact.kinetic_friction_ratio);
    row.friction_speed = physics.friction_decay_speed;
    row.rolling_stiffness = 2.25 * contact.rolling_friction * contact.rolling_friction;
    row.rolling_damping = 2.0 * physics.rolling_damping;
    row.rolling_damping_full = row.rolling_damping * physics.rolling_damping_sliding;
    set_cohesion(row, e_star, contact, physics, largest_radius);
    row.shared = physics.clump_contacts == ClumpPolicy::shared;
    row.booked = physics.energy_book;
    return row;
}

}  // namespace pelletlab::solver::detail
