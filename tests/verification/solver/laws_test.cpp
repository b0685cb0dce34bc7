// Contact laws beside Hertz–Mindlin: closed forms of each.
#include "figure.hpp"
#include "scene.hpp"
#include "solver/detail/damping_calibration.hpp"

namespace pelletlab::solver {
namespace {

using verification::figure;
using verification::figure_below;
using verification::figure_relative;

constexpr double radius = 2e-3;

/// A sphere that is thrown at a plane, or pulled from it.
struct Drop {
    SimulationDefinition d;
    std::unique_ptr<Simulation> s;

    explicit Drop(double step) {
        d.templates = {scene::sphere_template(radius, 2000.0)};
        d.pellet_material = {1e7, 0.25};
        WallDefinition plane = scene::wall("plane", scene::plate(0.1), {0.5, 0.0, 0.0}, {1e7, 0.25});
        plane.exact = exact_plane(Vec3::Zero(), Vec3::UnitZ());
        d.walls = {plane};
        d.gravity = Vec3::Zero();
        d.time_step = step;
        d.domain = Box(Vec3::Constant(-1.0), Vec3::Constant(1.0));
    }
    void start(double speed, double overlap = 0.0) {
        s = std::make_unique<Simulation>(d);
        BodyPlacement b;
        b.pose.position = {0, 0, radius - overlap};
        b.velocity = {0, 0, -speed};
        s->add_bodies({&b, 1});
    }
    double height() const { return s->bodies().position[0].z(); }
    double speed() const { return s->bodies().velocity[0].z(); }
    double mass() const { return d.templates[0].mass_properties.mass; }
    double e_star() const { return d.pellet_material.shear_modulus * 1.25 / (1.0 - 0.0625); }  // two equal materials
    double rebound(double v) {
        start(v);
        for (int k = 0; k < 400000; ++k) {
            s->step();
            if (height() > radius) return speed() / v;
        }
        ADD_FAILURE() << "does not come back";
        return 0.0;
    }
};

TEST(Laws, DampingWithoutTensionIsThatOfTheTable) {
    // Values of an independent integration (Runge–Kutta in time and bisection), to their six digits.
    const std::pair<double, double> table[] = {{0.10, 2.779862}, {0.20, 1.635122}, {0.40, 0.792705}, {0.50, 0.570815}, {0.80, 0.166263}, {0.95, 0.036891}};
    for (const auto& [e, alpha] : table)
        figure("Damping without tension, e = " + std::to_string(e).substr(0, 4), "alpha", alpha, detail::damping_without_tension(e), 3e-5);
}

TEST(Laws, LinearModelHasItsRestitutionAndContactTime) {
    const double k = 1e3, e = 0.6;
    Drop drop(2e-7);
    drop.d.physics.contact = ContactModel::linear;
    drop.d.physics.linear_stiffness = k;
    drop.d.walls[0].contact.restitution = e;
    const double beta = -std::log(e) / std::hypot(std::log(e), M_PI);
    drop.start(0.2);
    double time = 0.0;
    for (int n = 0; n < 200000 && time == 0.0; ++n) {
        drop.s->step();
        if (drop.height() > radius) time = drop.s->time();
    }
    figure("Linear model", "restitution", e, drop.speed() / 0.2, 1e-3);
    figure_relative("Linear model", "contact time [s]", M_PI / std::sqrt(k / drop.mass() * (1.0 - beta * beta)), time, 2e-3);
}

TEST(Laws, ViscoelasticRestitutionFallsWithSpeedAsTheSeries) {
    // Ramírez, Pöschel, Brilliantov & Schwager 1999: e = 1 − C₁ a v^(1/5) + C₂ a² v^(2/5) − C₃ a³ v^(3/5) …, a = (3/2) A (ρ/m)^(2/5), C₁ = 1.15344,
    // C₂ = (3/5) C₁², C₃ = 0.315119 C₁³… cut after three terms: small A.
    const double relaxation = 2e-6;
    for (const double v : {0.05, 0.2, 0.8}) {
        Drop drop(1e-7);
        drop.d.physics.contact = ContactModel::viscoelastic;
        drop.d.walls[0].contact.relaxation_time = relaxation;
        const double rho = 4.0 / 3.0 * drop.e_star() * std::sqrt(radius), a = 1.5 * relaxation * std::pow(rho / drop.mass(), 0.4) * std::pow(v, 0.2);
        const double series = 1.0 - 1.15344 * a + 0.6 * 1.15344 * 1.15344 * a * a;
        figure("Viscoelastic, v = " + std::to_string(v).substr(0, 4) + " m/s", "restitution", series, drop.rebound(v), 1e-4 + a * a * a);
    }
}

TEST(Laws, FrictionFallsFromStaticToKinetic) {
    // A plate that pulls away under a ball at speed v: force = (μ_k + (μ_s − μ_k)/(1 + v/v_c)) F_n.
    Drop drop(1e-6);
    drop.d.gravity = {0, 0, -9.81};
    drop.d.walls[0].contact = {0.1, 0.5, 0.0};
    drop.d.walls[0].contact.kinetic_friction_ratio = 0.4;
    drop.d.physics.friction_decay_speed = 0.1;
    drop.start(0.0, 5e-7);
    drop.s->advance(100000);
    WallMotion motion;
    motion.velocity = {0.3, 0, 0};
    drop.s->set_wall_motion(0, motion);
    drop.s->advance(50);
    const double slip = 0.3 - (drop.s->bodies().velocity[0].x() - radius * drop.s->bodies().spin[0].y());
    const WallLoad load = drop.s->wall_loads()[0];
    figure_relative("Rate-dependent friction", "friction coefficient", 0.2 + 0.3 / (1.0 + slip / 0.1), load.force.x() / load.force.z(), 2e-3);
}

TEST(Laws, SjkrPullsByItsContactArea) {
    Drop drop(1e-9);
    drop.d.physics.cohesion = Cohesion::sjkr;
    drop.d.walls[0].contact.restitution = 1.0;
    drop.d.walls[0].contact.cohesion_energy_density = 1e5;
    drop.start(0.0, 2e-6);
    const double d = 2e-6, expected = 4.0 / 3.0 * drop.e_star() * std::sqrt(radius) * std::pow(d, 1.5) - 1e5 * M_PI * 2.0 * radius * d;
    figure_relative("SJKR, overlap 2 um", "normal force [N]", expected, drop.s->bodies().force[0].z(), 1e-9);
}

TEST(Laws, JkrForceAtTouchAndAtPullOff) {
    const double w = 0.2;
    Drop drop(1e-9);
    drop.d.physics.cohesion = Cohesion::jkr;
    drop.d.walls[0].contact.restitution = 1.0;
    drop.d.walls[0].contact.work_of_adhesion = w;
    drop.start(0.0, 1e-15);
    figure_relative("JKR, touching", "force / (pi w R)", -4.0 / 3.0, drop.s->bodies().force[0].z() / (M_PI * w * radius), 1e-4);
    // Pulled away, the force passes −(3/2) π w R and the neck snaps at a gap of 0.4725 b²/R, b³ = 2 π w R²/E*.
    const double b = std::cbrt(2.0 * M_PI * w * radius * radius / drop.e_star()), unit = b * b / radius;
    drop.d.templates[0].mass_properties.mass *= 1e9;  // heavy: stays where it is while the plane leaves
    drop.d.templates[0].mass_properties.principal_inertia *= 1e9;
    drop.start(0.0, 1e-9);  // a contact begins by touching: for four steps
    WallMotion motion;
    motion.velocity = {0, 0, -unit / (10000.0 * drop.d.time_step)};
    drop.s->set_wall_motion(0, motion);
    double strongest = 0.0, snap = 0.0;
    for (int k = 0; k < 8000; ++k) {
        drop.s->step();
        const double force = drop.s->wall_loads()[0].force.z();
        strongest = std::max(strongest, force);
        if (force > 0.0) snap = drop.height() - radius - drop.s->wall_poses()[0].position.z();
    }
    figure_relative("JKR, pulled off", "largest pull / (pi w R)", 1.5, strongest / (M_PI * w * radius), 1e-3);
    figure_relative("JKR, pulled off", "gap at the snap [m]", 0.47247 * unit, snap, 1e-3);
    EXPECT_EQ(drop.s->wall_loads()[0].force.z(), 0.0);
    // Coming back it feels nothing until it touches.
    motion.velocity = -motion.velocity;
    drop.s->set_wall_motion(0, motion);
    drop.s->advance(4500);
    EXPECT_EQ(drop.s->wall_loads()[0].force.z(), 0.0);
}

TEST(Laws, CapillaryBridgeOfTwoSpheresReachesItsRuptureDistance) {
    const double tension = 0.0728, angle = 0.3, volume = 1e-12, rupture = (1.0 + 0.5 * angle) * std::cbrt(volume);
    SimulationDefinition d;
    d.templates = {scene::sphere_template(radius, 2e9)};
    d.pellet_material = {1e7, 0.25};
    d.pellet_contact = {1.0, 0.0, 0.0};
    d.physics.cohesion = Cohesion::capillary;
    d.physics.liquid = {tension, angle, volume};
    d.gravity = Vec3::Zero();
    d.time_step = 1e-6;
    Simulation s(d);
    std::vector<BodyPlacement> b(2);
    b[1].pose.position = {2.0 * radius - 1e-7, 0, 0};  // touches for five steps
    b[1].velocity = {0.02, 0, 0};
    s.add_bodies(b);
    double reached = 0.0;
    bool checked = false;
    for (int k = 0; k < 8000; ++k) {
        s.step();
        const double gap = (s.bodies().position[1] - s.bodies().position[0]).norm() - 2.0 * radius, pull = -s.bodies().force[1].x();
        if (pull > 0.0) reached = gap;
        if (!checked && gap > 0.4 * rupture) {
            const double x = gap * std::sqrt(radius / volume);  // 2 R* = r of equal spheres
            figure_relative("Capillary bridge", "pull at 0.4 of the rupture distance [N]",
                            2.0 * M_PI * radius * tension * std::cos(angle) / (1.0 + 1.05 * x + 2.5 * x * x), pull, 1e-6);
            checked = true;
        }
    }
    figure_relative("Capillary bridge", "rupture distance [m]", rupture, reached, 1e-3);
    EXPECT_EQ(s.bodies().force[1].x(), 0.0);
}

TEST(Laws, TerminalSpeedInStillAir) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(5e-5, 2000.0)};  // Re about 4
    d.domain = Box(Vec3::Constant(-100.0), Vec3::Constant(100.0));
    d.body_forces.air.density = 1.2;
    d.time_step = 1e-6;
    Simulation s(d);
    BodyPlacement b;
    s.add_bodies({&b, 1});
    s.advance(400000);
    const double v = -s.bodies().velocity[0].z(), reynolds = 1.2 * v * 1e-4 / 1.8e-5;
    const double expected = d.templates[0].mass_properties.mass * 9.81 / (3.0 * M_PI * 1.8e-5 * 1e-4 * (1.0 + 0.15 * std::pow(reynolds, 0.687)));
    figure_relative("Still air", "terminal speed [m/s]", expected, v, 1e-3);
}

/// A flat cylinder of n rim spheres landing on a plane: what each policy makes of the number of spheres (Berry et al. 2023).
struct Landing {
    double overlap, restitution;
};

Landing land(int spheres, ClumpPolicy policy) {
    SimulationDefinition d;
    RigidTemplate t = scene::cylinder_template(1, 1);
    const double r = 0.35e-3, ring = 1.56e-3 - r;
    t.spheres.clear();
    for (int k = 0; k < spheres; ++k)
        t.spheres.push_back(
            {{spheres == 1 ? 0.0 : ring * std::cos(2.0 * M_PI * k / spheres), spheres == 1 ? 0.0 : ring * std::sin(2.0 * M_PI * k / spheres), -1.48e-3 + r},
             r});
    t.bounding_radius = bounding_radius(t.spheres);
    d.templates = {t};
    d.pellet_material = {2e6, 0.25};
    WallDefinition plane = scene::wall("plane", scene::plate(0.1), {0.4, 0.0, 0.0}, {2e6, 0.25});
    plane.exact = exact_plane(Vec3::Zero(), Vec3::UnitZ());
    d.walls = {plane};
    d.domain = Box(Vec3::Constant(-1.0), Vec3::Constant(1.0));
    d.physics.clump_contacts = policy;
    d.time_step = 1e-6;
    Landing landing{};
    {
        d.gravity = Vec3::Zero();
        Simulation s(d);
        BodyPlacement b;
        b.pose.position = {0, 0, 1.48e-3};
        b.velocity = {0, 0, -0.05};
        s.add_bodies({&b, 1});
        for (int k = 0; k < 200000 && !(s.bodies().position[0].z() > 1.48e-3); ++k) s.step();
        landing.restitution = s.bodies().velocity[0].z() / 0.05;
    }
    d.gravity = {0, 0, -9.81};
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {0, 0, 1.48e-3 - 1e-6};
    s.add_bodies({&b, 1});
    s.advance(20000);
    landing.overlap = 1.48e-3 - s.bodies().position[0].z();
    return landing;
}

TEST(Laws, SharedContactsDoNotDependOnTheNumberOfSpheres) {
    const double m = scene::cylinder_template(1, 1).mass_properties.mass, e_star = 2e6 * 1.25 / (1.0 - 0.0625);
    const double single = std::pow(m * 9.81 / (4.0 / 3.0 * e_star * std::sqrt(0.35e-3)), 2.0 / 3.0);
    for (const int n : {1, 4, 16, 50, 200}) {
        const Landing sum = land(n, ClumpPolicy::sum), shared = land(n, ClumpPolicy::shared);
        const std::string name = "Cylinder landing flat on " + std::to_string(n) + " spheres, ";
        figure_relative(name + "sum", "rest overlap [m]", single / std::pow(n, 2.0 / 3.0), sum.overlap, 5e-3);
        figure_relative(name + "shared", "rest overlap [m]", single, shared.overlap, 5e-3);
        figure(name + "shared", "restitution", 0.4, shared.restitution, 5e-3);
        // Each of n parallel contacts is damped for the whole mass: ζ grows with sqrt(n). n = 1 has the restitution that was asked for.
        if (n == 1)
            figure(name + "sum", "restitution", 0.4, sum.restitution, 5e-3);
        else
            EXPECT_LT(sum.restitution, 0.35) << n;
        ::testing::Test::RecordProperty("restitution_sum_" + std::to_string(n), std::to_string(sum.restitution));
    }
}

TEST(Laws, EverySetOfInstructionsGivesTheSameBitsForEveryLaw) {
    for (const ContactModel contact : {ContactModel::hertz_edem, ContactModel::hertz_impulse_exact, ContactModel::linear, ContactModel::viscoelastic})
        for (const RollingModel rolling : {RollingModel::constant_torque, RollingModel::viscous, RollingModel::elastic_plastic})
            for (const Cohesion cohesion : {Cohesion::none, Cohesion::jkr, Cohesion::capillary}) {
                if (cohesion == Cohesion::jkr && contact == ContactModel::linear) continue;
                const auto run = [&](InstructionSet set) {
                    SimulationDefinition d = scene::falling_definition(scene::cylinder_template(2, 6), 5e-6);
                    d.physics.contact = contact, d.physics.rolling = rolling, d.physics.cohesion = cohesion;
                    d.physics.energy_book = rolling == RollingModel::viscous;
                    d.pellet_contact.work_of_adhesion = d.walls[0].contact.work_of_adhesion = 0.05;
                    d.pellet_contact.relaxation_time = 1e-5;
                    d.pellet_contact.kinetic_friction_ratio = cohesion == Cohesion::none ? 1.0 : 0.5;
                    d.instructions = set;
                    Simulation s(d);
                    s.add_bodies(scene::lattice(3, 3, 2, 4.5e-3, 3));
                    s.advance(1500);
                    double up = -1.0;
                    for (const Vec3& v : s.bodies().velocity) up = std::max(up, v.z());
                    EXPECT_GT(up, -0.1);  // the floor has stopped some: all fell at about 0.5 m/s
                    return s.state_hash();
                };
                EXPECT_EQ(run(InstructionSet::scalar), run(InstructionSet::fastest))
                    << static_cast<int>(contact) << static_cast<int>(rolling) << static_cast<int>(cohesion);
            }
}

TEST(Laws, CoincidentSpheresShowThePolicy) {
    // K spheres in one place: `sum` is K times as stiff, `shared` is bitwise as stiff as one up to the rounding of K shares.
    const auto force = [](std::size_t copies, ClumpPolicy policy) {
        Drop drop(1e-7);
        drop.d.templates[0].spheres.assign(copies, {Vec3::Zero(), radius});
        drop.d.physics.clump_contacts = policy;
        drop.start(0.0, 1e-6);
        return drop.s->bodies().force[0].z();
    };
    EXPECT_NEAR(force(4, ClumpPolicy::sum), 4.0 * force(1, ClumpPolicy::sum), 1e-12 * force(4, ClumpPolicy::sum));
    EXPECT_NEAR(force(4, ClumpPolicy::shared), force(1, ClumpPolicy::sum), 1e-12 * force(1, ClumpPolicy::sum));
    EXPECT_EQ(force(1, ClumpPolicy::shared), force(1, ClumpPolicy::sum));
}

}  // namespace
}  // namespace pelletlab::solver
