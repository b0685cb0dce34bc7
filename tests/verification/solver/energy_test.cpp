// The books of energy: what is put in is either there or booked as dissipated, by mechanism.
#include "figure.hpp"
#include "scene.hpp"

namespace pelletlab::solver {
namespace {

using verification::figure;
using verification::figure_below;
using verification::figure_relative;

/// Pellets flying about in a closed box.
SimulationDefinition box_definition(const RigidTemplate& pellet, double half, PairParameters contact, double step) {
    SimulationDefinition d;
    d.templates = {pellet};
    d.pellet_contact = contact;
    d.walls = {scene::wall("box", scene::box(Vec3::Constant(-half), Vec3::Constant(half)), contact, {2e6, 0.25})};
    d.gravity = Vec3::Zero();
    d.time_step = step;
    d.physics.energy_book = true;
    return d;
}

std::vector<BodyPlacement> gas(int n, double spacing, double speed) {
    std::vector<BodyPlacement> bodies = scene::lattice(n, n, n, spacing, 5, 0.0);
    const double lift = 0.5 * spacing * n + 0.1 * spacing;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        RandomStream random(9, k);
        bodies[k].pose.position.z() -= lift;
        bodies[k].velocity = Vec3(random.normal(), random.normal(), random.normal()) * speed;
    }
    return bodies;
}

double drift(int n, int steps, double step) {
    Simulation s(box_definition(scene::cylinder_template(3, 8), 0.5 * n * 5e-3 + 1e-3, {1.0, 0.0, 0.0}, step));
    s.add_bodies(gas(n, 5e-3, 0.3));
    const double start = s.energy().total();
    double worst = 0.0;
    for (int k = 0; k < 10; ++k) {
        s.advance(static_cast<std::uint64_t>(steps / 10));
        worst = std::max(worst, std::abs(s.energy().mechanical() / start - 1.0));
    }
    EXPECT_GT(s.contacts().touching_pairs + s.contacts().wall_contacts, 0u);
    return worst;
}

TEST(Energy, ElasticFrictionlessClumpsKeepTheirEnergy) {
    figure_below("Elastic box, 64 clumps × 24, 2e4 steps of 2e-6 s", "drift of energy", drift(4, 20000, 2e-6), 1e-4);
}

TEST(EnergyLong, ElasticFrictionlessBoxOfAThousandClumpsKeepsItsEnergy) {
    figure_below("Elastic box (long), 1000 clumps × 24, 1e5 steps of 2e-6 s", "drift of energy", drift(10, 100000, 2e-6), 1e-4);
}

/// A bed falls into a box whose floor shakes: everything dissipates and the wall does work.
void expect_balance(ContactModel contact, RollingModel rolling, const std::string& name, double step = 2e-6) {
    SimulationDefinition d = scene::falling_definition(scene::cylinder_template(3, 8), step);
    d.physics.contact = contact;
    d.physics.rolling = rolling;
    d.physics.energy_book = true;
    d.physics.linear_stiffness = 300.0;  // [N/m], about as soft as the Hertz contacts here
    d.pellet_contact.relaxation_time = d.walls[0].contact.relaxation_time = 5e-5;
    d.walls[0].motion.oscillation = {0.0, 0.0, 2e-4};
    d.walls[0].motion.frequency = 40.0;
    Simulation s(d);
    s.add_bodies(scene::lattice(4, 4, 4, 5e-3, 3));
    const double start = s.energy().total();
    const double height = s.energy().gravity;
    s.advance(static_cast<std::uint64_t>(std::llround(0.05 / step)));
    const EnergyReport e = s.energy();
    const double input = s.energy().kinetic_translation + e.dissipated() + std::abs(e.wall_work[0]) + std::abs(height - e.gravity);
    EXPECT_GT(e.sliding, 0.02 * input);
    EXPECT_GT(e.normal_damping, 0.05 * input);
    EXPECT_GT(e.rolling, 0.0);
    EXPECT_GT(std::abs(e.wall_work[0]), 0.0);
    figure_below(name, "imbalance / turnover", std::abs(e.total() - start) / input, 1e-4);
}

TEST(Energy, BooksBalanceOfEdemWithTypeA) {
    expect_balance(ContactModel::hertz_edem, RollingModel::constant_torque, "Energy book, edem, type A");
}
TEST(Energy, BooksBalanceOfImpulseExactWithTypeC) {
    expect_balance(ContactModel::hertz_impulse_exact, RollingModel::elastic_plastic, "Energy book, impulse exact, type C");
}
TEST(Energy, BooksBalanceOfLinearWithTypeB) {
    expect_balance(ContactModel::linear, RollingModel::viscous, "Energy book, linear, type B", 1e-6);  // its damping begins with a jump: half the step
}
TEST(Energy, BooksBalanceOfViscoelastic) {
    expect_balance(ContactModel::viscoelastic, RollingModel::constant_torque, "Energy book, viscoelastic");
}

TEST(Energy, BooksDoNotChangeTheRun) {
    const auto run = [](bool booked) {
        SimulationDefinition d = scene::falling_definition(scene::cylinder_template(3, 8));
        d.physics.energy_book = booked;
        Simulation s(d);
        s.add_bodies(scene::lattice(3, 3, 3, 5e-3, 3));
        s.advance(4000);
        return s.state_hash();
    };
    EXPECT_EQ(run(false), run(true));
}

TEST(Energy, NormalDampingOfOneImpactIsTheLossOfItsRestitution) {
    SimulationDefinition d;
    d.templates = {scene::sphere_template(2e-3, 2000.0)};
    d.pellet_material = {1e7, 0.25};
    d.walls = {scene::wall("floor", scene::plate(0.05), {0.5, 0.0, 0.0})};
    d.gravity = Vec3::Zero();
    d.time_step = 1e-7;
    d.physics.contact = ContactModel::hertz_impulse_exact;
    d.physics.energy_book = true;
    Simulation s(d);
    BodyPlacement b;
    b.pose.position = {0.001, 0.002, 2.0001e-3};
    b.velocity = {0.0, 0.0, -0.5};
    s.add_bodies({&b, 1});
    const double start = s.energy().kinetic_translation;
    s.advance(20000);
    figure_relative("One impact, e = 0.5", "normal damping / first energy", 0.75, s.energy().normal_damping / start, 1e-3);
}

/// Haff's law: T = T₀ / (1 + t/t_c)² for frictionless spheres of constant restitution.
TEST(Energy, GranularGasCoolsAfterHaff) {
    SimulationDefinition d = box_definition(scene::sphere_template(1e-3, 2000.0), 0.016, {0.9, 0.0, 0.0}, 1e-5);
    d.walls[0].contact.restitution = 1.0;
    d.physics.contact = ContactModel::linear;  // its restitution does not depend on the speed
    d.physics.linear_stiffness = 200.0;
    Simulation s(d);
    std::vector<BodyPlacement> bodies = gas(10, 3.1e-3, 0.5);
    for (BodyPlacement& b : bodies) b.spin = Vec3::Zero();
    s.add_bodies(bodies);
    s.advance(2000);  // a lattice first becomes a gas
    std::vector<double> times, roots;
    const double t0 = s.time();
    for (int k = 0; k < 30; ++k) {
        times.push_back(s.time() - t0);
        roots.push_back(1.0 / std::sqrt(s.energy().kinetic_translation));
        s.advance(300);
    }
    // 1/sqrt(T) must be a straight line in time: compare the slopes of both halves.
    const auto slope = [&](std::size_t a, std::size_t b) { return (roots[b] - roots[a]) / (times[b] - times[a]); };
    const double first = slope(0, 15), second = slope(14, 29);
    EXPECT_GT(roots.back(), 1.3 * roots.front());
    figure_relative("Haff cooling, 1000 spheres, e = 0.9", "slope of 1/sqrt(T), second half / first", 1.0, second / first,
                    0.1);  // 1000 spheres: statistics of some percent
}

TEST(Energy, GasOfClumpsCoolsAfterHaff) {
    SimulationDefinition d = box_definition(scene::dumbbell_template(1e-3, 1e-3, 2000.0), 0.020, {0.8, 0.0, 0.0}, 1e-5);
    d.walls[0].contact.restitution = 1.0;
    d.physics.contact = ContactModel::linear;
    d.physics.linear_stiffness = 200.0;
    Simulation s(d);
    s.add_bodies(gas(8, 4.4e-3, 0.5));
    s.advance(4000);  // translation and rotation share
    std::vector<double> times, roots;
    for (int k = 0; k < 30; ++k) {
        const EnergyReport e = s.energy();
        times.push_back(s.time());
        roots.push_back(1.0 / std::sqrt(e.kinetic_translation + e.kinetic_rotation));
        s.advance(400);
    }
    const auto slope = [&](std::size_t a, std::size_t b) { return (roots[b] - roots[a]) / (times[b] - times[a]); };
    EXPECT_GT(roots.back(), 1.3 * roots.front());
    figure_relative("Haff cooling, 512 clumps of two spheres, e = 0.8", "slope of 1/sqrt(T), second half / first", 1.0, slope(14, 29) / slope(0, 15), 0.12);
}

}  // namespace
}  // namespace pelletlab::solver
