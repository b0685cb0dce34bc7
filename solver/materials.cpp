#include <cmath>

#include "core/error.hpp"
#include "solver/detail/state.hpp"

namespace pelletlab::solver::detail {

namespace {

void check_range(bool good, const std::string& what, const std::string& quantity, const std::string& range) {
    if (!good) throw bad_input(what + ": " + quantity + " must be " + range, "correct it in the material or contact table");
}

}  // namespace

LawRow make_law_row(const ElasticMaterial& a, const ElasticMaterial& b, const PairParameters& contact, const std::string& what) {
    for (const ElasticMaterial& m : {a, b}) {
        check_range(m.shear_modulus > 0.0 && std::isfinite(m.shear_modulus), what, "the shear modulus", "positive");
        check_range(m.poisson_ratio > -1.0 && m.poisson_ratio <= 0.5, what, "Poisson's ratio", "in (-1, 0.5]");
    }
    check_range(contact.restitution >= 0.0 && contact.restitution <= 1.0, what, "the restitution", "in [0, 1]");
    check_range(contact.sliding_friction >= 0.0 && std::isfinite(contact.sliding_friction), what, "the sliding friction", "zero or positive");
    check_range(contact.rolling_friction >= 0.0 && std::isfinite(contact.rolling_friction), what, "the rolling friction", "zero or positive");
    const auto plane_compliance = [](const ElasticMaterial& m) { return (1.0 - m.poisson_ratio) / (2.0 * m.shear_modulus); };  // (1 − ν²)/E, E = 2 G (1 + ν)
    const auto shear_compliance = [](const ElasticMaterial& m) { return (2.0 - m.poisson_ratio) / m.shear_modulus; };
    const double e_star = 1.0 / (plane_compliance(a) + plane_compliance(b));
    const double g_star = 1.0 / (shear_compliance(a) + shear_compliance(b));
    double beta = -1.0;  // the limit of e → 0
    if (contact.restitution > 0.0) {
        const double log_e = std::log(contact.restitution);
        beta = log_e / std::sqrt(log_e * log_e + M_PI * M_PI);
    }
    LawRow row;
    row.normal_stiffness = 2.0 * e_star;
    row.tangential_ratio = 4.0 * g_star / e_star;
    row.damping = -2.0 * std::sqrt(5.0 / 6.0) * beta;
    row.tangential_damping = row.damping * std::sqrt(row.tangential_ratio);
    row.sliding_friction = contact.sliding_friction;
    row.rolling_friction = contact.rolling_friction;
    return row;
}

}  // namespace pelletlab::solver::detail
