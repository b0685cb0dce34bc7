// Chung & Ooi 2011 (Granular Matter 13:643), tests 1 to 8: single impacts of elastic and frictional spheres against closed forms and the published curves.
#include <fstream>
#include <sstream>

#include "figure.hpp"
#include "scene.hpp"

namespace pelletlab::solver {
namespace {

using verification::figure;
using verification::figure_below;
using verification::figure_relative;

struct Elastic {
    double modulus, poisson, density;
    ElasticMaterial material() const { return {modulus / (2.0 * (1.0 + poisson)), poisson}; }
};

constexpr Elastic glass{4.8e10, 0.20, 2800}, limestone{2.0e10, 0.25, 2500}, aluminium{7.0e10, 0.30, 2699}, magnesium{4.0e10, 0.35, 1800};
constexpr Elastic aluminium_oxide{3.8e11, 0.23, 4000}, iron{1.0e11, 0.25, 7000}, alloy{7.0e10, 0.33, 2700}, steel{2.08e11, 0.30, 7850};
constexpr ElasticMaterial rigid{1e20, 0.3};

/// Deepest overlap, strongest force and duration of one impact; and the overlap's mean, weighted by the force: by so much the lever of friction is shorter
/// than the radius, ∫ F δ dt / ∫ F dt.
struct Impact {
    double overlap = 0.0, force = 0.0, duration = 0.0, mean_overlap = 0.0;
};

/// Steps until the contact is over.
Impact follow(Simulation& s, double dt, const std::function<double()>& overlap_now, const std::function<double()>& force_now) {
    Impact impact;
    double last = overlap_now(), begin = 0.0, impulse = 0.0, moment = 0.0;
    for (int k = 0; k < 200000; ++k) {
        s.step();
        const double overlap = overlap_now(), force = force_now();
        impulse += force, moment += force * overlap;
        if (overlap > 0.0 && last <= 0.0) begin = s.time() - dt * overlap / (overlap - last);
        if (overlap <= 0.0 && last > 0.0) {
            impact.duration = s.time() - dt * overlap / (overlap - last) - begin;
            impact.mean_overlap = moment / impulse;
            return impact;
        }
        last = overlap;
        impact.overlap = std::max(impact.overlap, overlap);
        impact.force = std::max(impact.force, force);
    }
    ADD_FAILURE() << "the contact does not end";
    return impact;
}

void expect_hertz(const std::string& name, double k, double mass, double v, const Impact& got) {
    const double overlap = std::pow(5.0 * mass * v * v / (4.0 * k), 0.4);
    const double constant = 0.8 * std::sqrt(M_PI) * std::tgamma(0.4) / std::tgamma(0.9);
    figure_relative(name, "largest overlap [m]", overlap, got.overlap, 1e-4);
    figure_relative(name, "largest force [N]", k * std::pow(overlap, 1.5), got.force, 1e-4);
    figure_relative(name, "contact time [s]", constant * overlap / v, got.duration, 1e-3);
}

class HertzModels : public ::testing::TestWithParam<ContactModel> {
protected:
    std::string name(const std::string& test) const { return test + (GetParam() == ContactModel::hertz_edem ? ", edem" : ", impulse exact"); }
};
INSTANTIATE_TEST_SUITE_P(ChungOoi, HertzModels, ::testing::Values(ContactModel::hertz_edem, ContactModel::hertz_impulse_exact));

TEST_P(HertzModels, Test1TwoEqualSpheres) {
    for (const auto& [material, text] : {std::pair{glass, "glass"}, std::pair{limestone, "limestone"}}) {
        const double r = 0.01, v = 20.0;
        SimulationDefinition d;
        d.templates = {scene::sphere_template(r, material.density)};
        d.pellet_material = material.material();
        d.pellet_contact = {1.0, 0.35, 0.0};
        d.physics.contact = GetParam();
        d.gravity = Vec3::Zero();
        d.time_step = 1e-8;
        Simulation s(d);
        std::vector<BodyPlacement> b(2);
        b[0].pose.position = {-r - 1e-7, 0, 0}, b[1].pose.position = {r + 1e-7, 0, 0};
        b[0].velocity = {0.5 * v, 0, 0}, b[1].velocity = {-0.5 * v, 0, 0};
        s.add_bodies(b);
        const Impact got = follow(
            s, d.time_step, [&] { return 2.0 * r - (s.bodies().position[1] - s.bodies().position[0]).norm(); }, [&] { return s.bodies().force[1].x(); });
        const double e_star = material.modulus / (2.0 * (1.0 - material.poisson * material.poisson));
        expect_hertz(name(std::string("Chung & Ooi test 1, ") + text), 4.0 / 3.0 * e_star * std::sqrt(0.5 * r), 0.5 * d.templates[0].mass_properties.mass, v,
                     got);
    }
}

/// A sphere over a rigid plane.
struct OnPlane {
    SimulationDefinition d;
    double r;
    std::unique_ptr<Simulation> simulation;

    OnPlane(const Elastic& material, double radius, PairParameters contact, ContactModel model, double step, const Vec3& velocity, const Vec3& spin)
        : r(radius) {
        d.templates = {scene::sphere_template(radius, material.density)};
        d.pellet_material = material.material();
        d.physics.contact = model;
        d.gravity = Vec3::Zero();
        d.time_step = step;
        WallDefinition wall = scene::wall("plane", scene::plate(1.0), contact, rigid);
        wall.exact = exact_plane(Vec3::Zero(), Vec3::UnitZ());
        d.walls = {wall};
        d.domain = Box(Vec3::Constant(-10.0), Vec3::Constant(10.0));
        simulation = std::make_unique<Simulation>(d);
        BodyPlacement b;
        b.pose.position = {0, 0, radius - 0.25 * velocity.z() * step};
        b.velocity = velocity, b.spin = spin;
        simulation->add_bodies({&b, 1});
    }
    Impact impact() {
        return follow(
            *simulation, d.time_step, [this] { return r - simulation->bodies().position[0].z(); }, [this] { return simulation->bodies().force[0].z(); });
    }
    const BodyState& bodies() const { return simulation->bodies(); }
    /// Velocity of the sphere's lowest point along x.
    double patch_speed() const { return bodies().velocity[0].x() - r * bodies().spin[0].y(); }
};

TEST_P(HertzModels, Test2SphereOnARigidPlane) {
    for (const auto& [material, text] : {std::pair{aluminium, "aluminium"}, std::pair{magnesium, "magnesium"}}) {
        OnPlane run(material, 0.1, {1.0, 0.0, 0.0}, GetParam(), 2e-7, {0, 0, -0.2}, Vec3::Zero());
        const Impact got = run.impact();
        const double e_star = material.modulus / (1.0 - material.poisson * material.poisson);
        expect_hertz(name(std::string("Chung & Ooi test 2, ") + text), 4.0 / 3.0 * e_star * std::sqrt(0.1), run.d.templates[0].mass_properties.mass, 0.2, got);
    }
}

TEST_P(HertzModels, Test3RestitutionOutIsRestitutionIn) {
    // The last step of a contact that may pull meets overlap zero with an error of order one step of some thousand: 1e-3.
    for (const auto& [material, text] : {std::pair{aluminium_oxide, "aluminium oxide"}, std::pair{iron, "cast iron"}})
        for (const double e : {1.0, 0.8, 0.6, 0.4, 0.2}) {
            OnPlane run(material, 2.5e-3, {e, 0.0, 0.0}, GetParam(), 2e-9, {0, 0, -3.9}, Vec3::Zero());
            run.impact();
            figure(name(std::string("Chung & Ooi test 3, ") + text), "restitution", e, run.bodies().velocity[0].z() / 3.9, 1e-3);
        }
}

std::vector<std::pair<double, double>> curve(const std::string& file) {
    std::ifstream in(std::string(PELLETLAB_SHARED_DIR) + "/data/chung_ooi_2011/" + file);
    std::vector<std::pair<double, double>> points;
    for (std::string line; std::getline(in, line);) {
        double x = 0.0, y = 0.0;
        if (std::sscanf(line.c_str(), "%lf,%lf", &x, &y) == 2) points.emplace_back(x, y);
    }
    return points;
}

struct Oblique {
    double restitution, spin, rebound_angle, patch;
};

Oblique oblique_impact(double degrees, ContactModel model) {
    const double angle = degrees * M_PI / 180.0, v = 3.9;
    OnPlane run(aluminium_oxide, 2.5e-3, {0.98, 0.092, 0.0}, model, 4e-9, {v * std::sin(angle), 0, -v * std::cos(angle)}, Vec3::Zero());
    run.impact();
    const Vec3 out = run.bodies().velocity[0];
    return {out.x() / (v * std::sin(angle)), run.bodies().spin[0].y(), std::atan2(run.patch_speed(), out.z()) * 180.0 / M_PI, run.patch_speed()};
}

TEST(ChungOoi, Test4FollowsThePublishedCurves) {
    struct Row {
        const char *file, *quantity;
        double gate;
        double (*of)(const Oblique&);
    };
    for (const Row& row :
         {Row{"test4_tangential_restitution.csv", "mean error of tangential restitution / largest", 0.01, [](const Oblique& o) { return o.restitution; }},
          Row{"test4_angular_velocity.csv", "mean error of spin / largest", 0.01, [](const Oblique& o) { return -o.spin; }},
          Row{"test4_rebound_angle.csv", "mean error of rebound angle / largest", 0.017, [](const Oblique& o) { return o.rebound_angle; }}}) {
        const auto points = curve(row.file);
        if (points.empty()) GTEST_SKIP() << "the shared data are not there";
        double error = 0.0, largest = 0.0;
        for (const auto& [x, y] : points) {
            error += std::abs(row.of(oblique_impact(x, ContactModel::hertz_edem)) - y) / static_cast<double>(points.size());
            largest = std::max(largest, std::abs(y));
        }
        figure_below("Chung & Ooi test 4, edem", row.quantity, error / largest, row.gate);
    }
}

TEST(ChungOoi, Test4GrossSlidingIsTheExactImpulse) {
    // e_t = 1 − μ (1 + e) / tan θ where V_st ≥ (7/2) μ (1 + e) V_n, here from 33° on; impulse_exact has the impulse to the error of restitution, 1e-4.
    for (const double degrees : {45.0, 60.0, 75.0}) {
        const double expected = 1.0 - 0.092 * 1.98 / std::tan(degrees * M_PI / 180.0);
        figure("Chung & Ooi test 4, impulse exact, " + std::to_string(static_cast<int>(degrees)) + "°", "tangential restitution", expected,
               oblique_impact(degrees, ContactModel::hertz_impulse_exact).restitution, 1e-4);
    }
}

// In gross sliding the impulses are exact whatever the tangential spring does: friction's is μ times the normal one, P = μ m (1 + e) V_n. Its lever about the
// centre is r (1 − λ), since the contact lies on the wall, an overlap nearer than r: λ = ∫ F δ dt / (r ∫ F dt). The published closed forms are those of rigid
// spheres, λ = 0. So the tests ask for two things: the impulses with the lever that was there, at the published stiffness; and the closed form itself where
// the sphere is so stiff that λ is less than the tolerance (λ falls with modulus^−0.4).

TEST_P(HertzModels, Test5GrossSlidingAtConstantNormalSpeed) {
    // Elastic: V_st'/(μ V_n') = x − 7 + 5 λ and r ω'/(μ V_n) = −5 (1 − λ) with x = V_st/(μ V_n) ≥ 7.
    const double r = 1e-5, vn = 5.0, mu = 0.3;
    for (const double x : {9.0, 13.0, 20.0}) {
        OnPlane run(steel, r, {1.0, mu, 0.0}, GetParam(), 1.5e-12, {x * mu * vn, 0, -vn}, Vec3::Zero());
        const double lever = run.impact().mean_overlap / r;
        const std::string title = name("Chung & Ooi test 5, x = " + std::to_string(static_cast<int>(x)));
        figure(title, "V_st'/(mu V_n), lever r (1 − λ)", x - 7.0 + 5.0 * lever, run.patch_speed() / (mu * vn), 1e-4);
        figure(title, "r w'/(mu V_n), lever r (1 − λ)", 5.0 * (1.0 - lever), r * run.bodies().spin[0].y() / (mu * vn), 1e-4);
    }
}

TEST(ChungOoi, Test5StiffSpheresAreTheRigidClosedForm) {
    // The published steel has λ = 0.0053, so 5 λ is 0.026: a modulus 1e7 times as high brings that below 1e-4.
    const double r = 1e-5, vn = 5.0, mu = 0.3, x = 13.0;
    const Elastic stiff{1e7 * steel.modulus, steel.poisson, steel.density};
    OnPlane run(stiff, r, {1.0, mu, 0.0}, ContactModel::hertz_impulse_exact, 2e-15, {x * mu * vn, 0, -vn}, Vec3::Zero());
    run.impact();
    figure("Chung & Ooi test 5, x = 13, impulse exact, modulus × 1e7", "V_st'/(mu V_n)", x - 7.0, run.patch_speed() / (mu * vn), 1e-4);
}

/// Published cases of test 6 have x = (7/2) μ (1 + e) V_n / V_st from 0.18 to 0.77 in the sliding regime; beta = x − 1, with the lever x (1 − (5/7) λ) − 1.
TEST(ChungOoi, Test6SpinningSphereInTheSlidingRegime) {
    const double r = 0.1, vn = 0.2, mu = 0.4, e = 0.5;
    for (const double x : {0.176, 0.352, 0.551, 0.771}) {
        const double slip = 3.5 * mu * (1.0 + e) * vn / x;
        const std::string title = "Chung & Ooi test 6, impulse exact, x = " + std::to_string(x).substr(0, 5);
        OnPlane run(alloy, r, {e, mu, 0.0}, ContactModel::hertz_impulse_exact, 1e-7, {0, 0, -vn}, {0, -slip / r, 0});
        const double lever = run.impact().mean_overlap / r;
        figure(title, "beta, lever r (1 − λ)", x * (1.0 - 5.0 / 7.0 * lever) - 1.0, -run.patch_speed() / slip, 1e-5);
        const Elastic stiff{1e3 * alloy.modulus, alloy.poisson, alloy.density};
        OnPlane rigid_run(stiff, r, {e, mu, 0.0}, ContactModel::hertz_impulse_exact, 6e-9, {0, 0, -vn}, {0, -slip / r, 0});
        rigid_run.impact();
        figure(title + ", modulus × 1000", "beta", x - 1.0, -rigid_run.patch_speed() / slip, 1e-4);
    }
}

TEST(ChungOoi, Test6EdemDeviatesAsItsTensionAndTotalSpringSay) {
    // The form of the reference study is not impulse exact at e = 0.5: the solver's design measured 0.11 … 0.18 with tangential damping.
    const double r = 0.1, vn = 0.2, mu = 0.4, e = 0.5, x = 0.551, slip = 3.5 * mu * (1.0 + e) * vn / x;
    OnPlane run(alloy, r, {e, mu, 0.0}, ContactModel::hertz_edem, 1e-7, {0, 0, -vn}, {0, -slip / r, 0});
    run.impact();
    const double deviation = std::abs(-run.patch_speed() / slip - (x - 1.0));
    EXPECT_GT(deviation, 1e-3);
    EXPECT_LT(deviation, 0.2);
}

TEST_P(HertzModels, Test7EqualSpheresWithOppositeSpinsDoNotSlip) {
    const double r = 0.1, v = 0.2;
    SimulationDefinition d;
    d.templates = {scene::sphere_template(r, alloy.density)};
    d.pellet_material = alloy.material();
    d.pellet_contact = {0.5, 0.4, 0.0};
    d.physics.contact = GetParam();
    d.gravity = Vec3::Zero();
    d.time_step = 5e-7;
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    b[0].pose.position = {-r - 1e-8, 0, 0}, b[1].pose.position = {r + 1e-8, 0, 0};
    b[0].velocity = {v, 0, 0}, b[1].velocity = {-v, 0, 0};
    b[0].spin = {0, 0, 3.0}, b[1].spin = {0, 0, -3.0};
    s.add_bodies(b);
    s.advance(4000);
    ASSERT_LT(s.bodies().velocity[0].x(), 0.0);
    figure(name("Chung & Ooi test 7"), "tangential velocity [m/s]", 0.0, s.bodies().velocity[0].y(), 1e-12);
    figure(name("Chung & Ooi test 7"), "spin [rad/s]", 3.0, s.bodies().spin[0].z(), 1e-12);
}

TEST(ChungOoi, Test8SphereOnAHeavySphere) {
    // As test 6 against a sphere of five times the radius, a thousand times the density and modulus: nearly a rigid plane with R* = r R / (r + R).
    const double r = 0.1, vn = 0.2, mu = 0.4, e = 0.5;
    const double x = 0.551, slip = 3.5 * mu * (1.0 + e) * vn / x;
    SimulationDefinition d;
    d.templates = {scene::sphere_template(r, alloy.density), scene::sphere_template(0.5, 1000.0 * alloy.density)};
    d.pellet_material = alloy.material();
    d.pellet_contact = {e, mu, 0.0};
    d.physics.contact = ContactModel::hertz_impulse_exact;
    d.gravity = Vec3::Zero();
    d.time_step = 1e-7;
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    b[0].pose.position = {0, 0, r + 1e-9};
    b[0].velocity = {0, 0, -vn}, b[0].spin = {0, -slip / r, 0};
    b[1].template_index = 1, b[1].pose.position = {0, 0, -0.5};
    s.add_bodies(b);
    s.advance(30000);
    ASSERT_GT(s.bodies().velocity[0].z(), 0.0);
    const double patch = s.bodies().velocity[0].x() - r * s.bodies().spin[0].y();
    figure("Chung & Ooi test 8, impulse exact, x = 0.551", "beta", x - 1.0, -patch / slip, 5e-4);  // lever and the heavy sphere's recoil (8e-6 of the mass)
}

}  // namespace
}  // namespace pelletlab::solver
