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

/// M⁻¹ K and M⁻¹ C of one body pressed by neighbours.
struct Pressed {
    Matrix6 stiffness = Matrix6::Zero(), damping = Matrix6::Zero();
    double largest() const { return Eigen::SelfAdjointEigenSolver<Matrix6>(stiffness, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff(); }
};

/// Normal damping coefficient of a contact of this stiffness, and the tangential one.
std::pair<double, double> damping_of(const detail::LawRow& law, const Physics& physics, double stiffness, double mass) {
    if (physics.contact == ContactModel::viscoelastic) return {law.damping * stiffness, law.tangential_damping * stiffness};
    const double root = std::sqrt(stiffness * mass);
    return {law.damping * root, law.tangential_damping * root};
}

/// JKR's overlap and neck in its own units: δ = (b²/R) (x² − sqrt x), F = (E* b³/R) (4/3 x³ − 2 x^1.5), a² = b² x; see solver/detail/cohesion_impl.hpp.
struct JkrUnits {
    double b, length;  ///< [m]: b, and b²/R
    JkrUnits(const detail::LawRow& law, double radius) : b(std::cbrt(law.cohesion_strength * radius * radius)), length(b * b / radius) {}
};

/// dF/dδ of the normal direction [N/m]; of a contact without cohesion, and where cohesion only pulls with a force, Hertz's or the linear spring's. Pulls that
/// fall with the overlap soften the contact and are left out; a neck about to snap has a falling force: it cannot oscillate, so it sets no limit either.
double normal_stiffness(const detail::LawRow& law, double hertz, double radius, double overlap) {
    if (law.cohesion != Cohesion::jkr) return hertz;
    const JkrUnits units(law, radius);
    const double d = overlap / units.length;
    double x = 1.0 + std::sqrt(d);
    for (int k = 0; k < 40; ++k) x -= (x * x - std::sqrt(x) - d) / (2.0 * x - 0.5 / std::sqrt(x));
    return law.half_modulus * units.b * (8.0 * std::pow(x, 2.5) - 6.0 * x) / (4.0 * std::pow(x, 1.5) - 1.0);
}

/// Overlap at which cohesion alone holds a contact: elastic push = pull [m].
double resting_overlap(const detail::LawRow& law, const Physics& physics, double radius) {
    if (law.cohesion == Cohesion::none) return 0.0;
    if (law.cohesion == Cohesion::jkr) return 0.5723571212766659 * JkrUnits(law, radius).length;  // x^1.5 = 3/2
    const bool linear = physics.contact == ContactModel::linear;
    if (law.cohesion == Cohesion::sjkr)  // k R δ against K δ or (2/3) S δ
        return linear ? 0.0 : std::pow(1.5 * law.cohesion_strength * radius / law.normal_stiffness, 2) / radius;
    const double pull = law.cohesion_strength * (law.cohesion == Cohesion::capillary ? radius : 1.0);
    return linear ? pull / law.normal_stiffness : std::pow(1.5 * pull / (law.normal_stiffness * std::sqrt(radius)), 2.0 / 3.0);
}

/// Adds the contacts of a body pressed against a plane in direction u until its foremost sphere overlaps by `depth`.
void press(Pressed& sum, const detail::BodyTemplate& t, const detail::LawRow& law, const Physics& physics, const Vec3& u, double depth, double partner_share,
           double partner_mobility) {
    double top = -std::numeric_limits<double>::infinity(), overlaps = 0.0;
    for (const auto& s : t.balls) top = std::max(top, u.dot(Vec3(s.x, s.y, s.z)) + s.r);
    const auto overlap_of = [&](const detail::Ball& s) { return depth - (top - u.dot(Vec3(s.x, s.y, s.z)) - s.r); };
    for (const auto& s : t.balls) overlaps += std::max(0.0, overlap_of(s));
    const Vec3 root_inertia = t.inertia.cwiseSqrt().cwiseInverse();
    const double root_mass = std::sqrt(t.inverse_mass), pair_mass = t.mass / partner_mobility;
    for (const auto& s : t.balls) {
        const Vec3 centre(s.x, s.y, s.z);
        const double overlap = overlap_of(s);
        if (overlap <= 0.0) continue;
        const double share = law.shared ? overlap / overlaps : 1.0, radius = s.r * partner_share;
        const bool linear = physics.contact == ContactModel::linear;
        const double stiffness = law.normal_stiffness * (linear ? 1.0 : std::sqrt(radius * overlap));
        const auto [normal_damping, tangential_damping] = damping_of(law, physics, stiffness, pair_mass);
        const Vec3 arm = centre + u * s.r;
        for (int k = 0; k < 3; ++k) {  // normal and two tangential directions, all with their own stiffness
            const Vec3 side = k == 0 ? u : (k == 1 ? u.unitOrthogonal() : Vec3(u.cross(u.unitOrthogonal())));
            Eigen::Matrix<double, 6, 1> j;
            j << side * root_mass, arm.cross(side).cwiseProduct(root_inertia);
            const Matrix6 mode = share * j * j.transpose();
            sum.stiffness += (k == 0 ? normal_stiffness(law, stiffness, radius, overlap) : stiffness * law.tangential_ratio) * mode;
            sum.damping += (k == 0 ? normal_damping : tangential_damping) * mode;
        }
        if (physics.rolling != RollingModel::elastic_plastic) continue;
        const double secant = linear ? stiffness : 2.0 / 3.0 * stiffness, rolling = law.rolling_stiffness * secant * radius * radius;
        const double inertia = t.smallest_inertia / partner_mobility + pair_mass * s.r * s.r;
        for (int k = 0; k < 3; ++k) {
            sum.stiffness(3 + k, 3 + k) += share * rolling * t.inverse_inertia[k];
            sum.damping(3 + k, 3 + k) += share * law.rolling_damping * std::sqrt(inertia * rolling) * t.inverse_inertia[k];
        }
    }
}

/// Largest Δt for which no mode grows: the eigenvalues of M⁻¹ (K Δt² + 4 C Δt) must stay below 4. That is where the factor of velocity Verlet with
/// predicted velocities, whose damping force lags half a step, reaches −1: h² + 8 ζ h = 4 with h = ω Δt.
double stable_step(const Pressed& p, double mobility) {
    double low = 0.0, high = 2.0 / std::sqrt(p.largest() * mobility);
    for (int k = 0; k < 30; ++k) {
        const double dt = 0.5 * (low + high);
        const Matrix6 sum = mobility * dt * (p.stiffness * dt + 4.0 * p.damping);
        const bool stable = Eigen::SelfAdjointEigenSolver<Matrix6>(sum, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff() < 4.0;
        (stable ? low : high) = dt;
    }
    return low;
}

}  // namespace

double TimeStepAdvice::limit_at(double overlap) const {
    return hertz && overlap > 0.0 ? contact_limit * std::pow(assumed_overlap_ratio / overlap, 0.25) : contact_limit;
}

TimeStepAdvice advise_time_step(const SimulationDefinition& d) {
    TimeStepAdvice advice;
    advice.hertz = d.physics.contact != ContactModel::linear;
    advice.rayleigh = advice.contact_limit = advice.damped_limit = std::numeric_limits<double>::infinity();
    advice.assumed_overlap_ratio = overlap_ratio;
    const double g = d.pellet_material.shear_modulus, nu = d.pellet_material.poisson_ratio;
    for (const RigidTemplate& rigid : d.templates) {
        const detail::BodyTemplate t = detail::make_body_template(rigid);
        if (t.density > 0.0) advice.rayleigh = std::min(advice.rayleigh, M_PI * t.smallest_radius * std::sqrt(t.density / g) / (0.1631 * nu + 0.8766));
        const auto consider = [&](const detail::LawRow& law, double partner_share, double partner_mobility, const std::string& partner) {
            // Pressed by so much beyond where cohesion holds the contacts anyway.
            const double depth = overlap_ratio * t.smallest_radius + resting_overlap(law, d.physics, t.largest_radius * partner_share);
            double largest = -1.0;
            Pressed worst;
            for (const Vec3& u : directions()) {
                Pressed pressed;
                for (const Vec3& side : {u, Vec3(-u)}) press(pressed, t, law, d.physics, side, depth, partner_share, partner_mobility);
                if (const double here = pressed.largest(); here > largest) largest = here, worst = pressed;
            }
            const double limit = 2.0 / std::sqrt(largest * partner_mobility);
            if (limit < advice.contact_limit) {
                advice.contact_limit = limit, advice.limited_by = "«" + rigid.name + "» against " + partner;
                advice.assumed_overlap_ratio = depth / t.smallest_radius;
            }
            advice.damped_limit = std::min(advice.damped_limit, stable_step(worst, partner_mobility));
        };
        consider(detail::make_law_row(d.pellet_material, d.pellet_material, d.pellet_contact, d.physics, t.largest_radius, "pellet-pellet"), 0.5, 2.0,
                 "its like");
        for (const WallDefinition& wall : d.walls)
            consider(detail::make_law_row(d.pellet_material, wall.material, wall.contact, d.physics, t.largest_radius, "pellet-" + wall.name), 1.0, 1.0,
                     "wall «" + wall.name + "»");
    }
    return advice;
}

}  // namespace pelletlab::solver
