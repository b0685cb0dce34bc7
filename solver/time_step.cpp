#include "solver/time_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/detail/state.hpp"

namespace pelletlab::solver {

namespace {

constexpr double overlap_ratio = 0.1;
constexpr int direction_count = 200;

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Directions spread over the sphere (Fibonacci), and the body's axes, where flat faces are.
std::vector<Vec3> directions() {
    std::vector<Vec3> all;
    for (int k = 0; k < 3; ++k) all.push_back(Vec3::Unit(k)), all.push_back(-Vec3::Unit(k));
    for (int k = 0; k < direction_count; ++k) {
        const double z = 1.0 - (2.0 * k + 1.0) / direction_count, angle = 2.399963229728653 * k, s = std::sqrt(1.0 - z * z);
        all.push_back({s * std::cos(angle), s * std::sin(angle), z});
    }
    return all;
}

/// Largest eigenvalue [1/s²] of M⁻¹ K for a body pressed against a plane in direction u until its foremost sphere overlaps by `depth`.
double largest_eigenvalue(const detail::BodyTemplate& t, const detail::LawRow& law, const Vec3& u, double depth, double partner_share) {
    double top = -std::numeric_limits<double>::infinity();
    for (const auto& s : t.balls) top = std::max(top, u.dot(Vec3(s.x, s.y, s.z)) + s.r);
    const Vec3 root_inertia = t.inertia.cwiseSqrt().cwiseInverse();
    const double root_mass = std::sqrt(t.inverse_mass);
    Matrix6 sum = Matrix6::Zero();
    for (const auto& s : t.balls) {
        const Vec3 centre(s.x, s.y, s.z);
        const double overlap = depth - (top - u.dot(centre) - s.r);
        if (overlap <= 0.0) continue;
        const double stiffness = law.normal_stiffness * std::sqrt(s.r * partner_share * overlap);
        const Vec3 arm = centre + u * s.r;
        for (int k = 0; k < 3; ++k) {  // normal and two tangential directions, all with their own stiffness
            const Vec3 side = k == 0 ? u : (k == 1 ? u.unitOrthogonal() : Vec3(u.cross(u.unitOrthogonal())));
            Eigen::Matrix<double, 6, 1> j;
            j << side * root_mass, arm.cross(side).cwiseProduct(root_inertia);
            sum += (k == 0 ? stiffness : stiffness * law.tangential_ratio) * j * j.transpose();
        }
    }
    return Eigen::SelfAdjointEigenSolver<Matrix6>(sum, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

}  // namespace

TimeStepAdvice advise_time_step(const SimulationDefinition& d) {
    TimeStepAdvice advice;
    advice.rayleigh = advice.contact_limit = std::numeric_limits<double>::infinity();
    advice.assumed_overlap_ratio = overlap_ratio;
    const double g = d.pellet_material.shear_modulus, nu = d.pellet_material.poisson_ratio;
    for (const RigidTemplate& rigid : d.templates) {
        const detail::BodyTemplate t = detail::make_body_template(rigid);
        if (t.density > 0.0) advice.rayleigh = std::min(advice.rayleigh, M_PI * t.smallest_radius * std::sqrt(t.density / g) / (0.1631 * nu + 0.8766));
        const double depth = overlap_ratio * t.smallest_radius;
        const auto consider = [&](const detail::LawRow& law, double partner_share, double partner_mobility, const std::string& partner) {
            double largest = 0.0;
            for (const Vec3& u : directions())
                largest = std::max(largest, largest_eigenvalue(t, law, u, depth, partner_share) + largest_eigenvalue(t, law, -u, depth, partner_share));
            const double limit = 2.0 / std::sqrt(largest * partner_mobility);
            if (limit < advice.contact_limit) advice.contact_limit = limit, advice.limited_by = "«" + rigid.name + "» against " + partner;
        };
        consider(detail::make_law_row(d.pellet_material, d.pellet_material, d.pellet_contact, "pellet-pellet"), 0.5, 2.0, "its like");
        for (const WallDefinition& wall : d.walls)
            consider(detail::make_law_row(d.pellet_material, wall.material, wall.contact, "pellet-" + wall.name), 1.0, 1.0, "wall «" + wall.name + "»");
    }
    return advice;
}

}  // namespace pelletlab::solver
