// Rolling friction, Ai, Chen, Rotter & Ooi 2011 (Powder Technology 206:269): a ball on a level plane and on an incline, types A, B and C.
#include "figure.hpp"
#include "scene.hpp"

namespace pelletlab::solver {
namespace {

using verification::figure;
using verification::figure_below;
using verification::figure_relative;

constexpr double radius = 5e-3, gravity = 9.81;

/// A ball resting on a plane; gravity is tilted by `slope` towards +x.
struct BallOnPlane {
    SimulationDefinition d;
    std::unique_ptr<Simulation> s;

    BallOnPlane(RollingModel rolling, double rolling_friction, double slope, double speed, double spin, double step = 1e-5) {
        d.templates = {scene::sphere_template(radius, 2500.0)};
        d.pellet_material = {4e6, 0.25};
        WallDefinition plane = scene::wall("plane", scene::plate(10.0), {0.02, 0.8, rolling_friction}, {1e12, 0.25});
        plane.exact = exact_plane(Vec3::Zero(), Vec3::UnitZ());
        d.walls = {plane};
        d.physics.rolling = rolling;
        d.gravity = Vec3(std::sin(slope), 0, -std::cos(slope)) * gravity;
        d.time_step = step;
        d.domain = Box(Vec3::Constant(-100.0), Vec3::Constant(100.0));
        const double weight = d.templates[0].mass_properties.mass * gravity * std::cos(slope);
        const double e_star = 2.0 * d.pellet_material.shear_modulus * 1.25 / (1.0 - 0.0625);
        overlap = std::pow(weight / (4.0 / 3.0 * e_star * std::sqrt(radius)), 2.0 / 3.0);
        s = std::make_unique<Simulation>(d);
        BodyPlacement b;
        b.pose.position = {0, 0, radius - overlap};
        b.velocity = {speed, 0, 0}, b.spin = {0, spin, 0};
        s->add_bodies({&b, 1});
    }
    double overlap = 0.0;
    double speed() const { return s->bodies().velocity[0].x(); }
    double kinetic() const { return s->energy().kinetic_translation + s->energy().kinetic_rotation; }
};

double deceleration(RollingModel model, double friction, double from, double until) {
    BallOnPlane run(model, friction, 0.0, 1.0, 1.0 / radius);
    run.s->advance(static_cast<std::uint64_t>(std::llround(from / run.d.time_step)));
    const double v = run.speed(), t = run.s->time();
    run.s->advance(static_cast<std::uint64_t>(std::llround((until - from) / run.d.time_step)));
    return (v - run.speed()) / (run.s->time() - t);
}

TEST(Rolling, TypeADeceleratesByFiveSeventhsOfMuRG) {
    figure_relative("Ai et al. 2011 test A, type A", "deceleration [m/s²]", 5.0 / 7.0 * 0.1 * gravity,
                    deceleration(RollingModel::constant_torque, 0.1, 0.1, 0.5), 5e-3);
}

TEST(Rolling, TypeCDeceleratesLikeTypeAOnceItsTorqueIsFull) {
    figure_relative("Ai et al. 2011 test A, type C", "deceleration [m/s²]", 5.0 / 7.0 * 0.1 * gravity,
                    deceleration(RollingModel::elastic_plastic, 0.1, 0.2, 0.5), 5e-3);
}

TEST(Rolling, TypeBDecaysExponentially) {
    // (7/5) m v' = −M/r with M = μ_r r F (r ω / 1 m/s) and v = r ω: v = v₀ exp(−(5/7) μ_r g t / 1 m/s).
    BallOnPlane run(RollingModel::viscous, 0.1, 0.0, 1.0, 1.0 / radius);
    run.s->advance(10000);
    const double v = run.speed();
    run.s->advance(40000);
    figure_relative("Ai et al. 2011 test A, type B", "rate of decay [1/s]", 5.0 / 7.0 * 0.1 * gravity, std::log(v / run.speed()) / 0.4, 5e-3);
}

TEST(Rolling, SlidingBallBeginsToRollWhenTheFormulaSays) {
    const double mu = 0.8, mu_r = 0.1, slip_ends = 1.0 / (gravity * (3.5 * mu - 2.5 * mu_r));
    BallOnPlane run(RollingModel::constant_torque, mu_r, 0.0, 1.0, 0.0, 2e-6);
    double time = 0.0;
    for (int k = 0; k < 60000 && time == 0.0; ++k) {
        run.s->step();
        if (run.speed() - radius * run.s->bodies().spin[0].y() <= 0.0) time = run.s->time();
    }
    figure_relative("Ai et al. 2011 test A", "end of sliding [s]", slip_ends, time, 1e-2);  // the spring of the last moment of sliding takes its time
}

TEST(Rolling, TypeCComesToRestWithTheOscillationOfItsSpring) {
    const double mu_r = 0.2;
    BallOnPlane run(RollingModel::elastic_plastic, mu_r, 0.0, 0.1, 0.1 / radius);
    const double start = run.kinetic();
    // Rest is reached at about v / ((5/7) μ_r g) = 0.07 s; then the rolling spring rings: zero crossings of the spin are half a period apart.
    run.s->advance(8000);
    std::vector<double> crossings;
    double last = run.s->bodies().spin[0].y();
    for (int k = 0; k < 40000 && crossings.size() < 5; ++k) {
        run.s->step();
        const double now = run.s->bodies().spin[0].y();
        if (last * now < 0.0) crossings.push_back(run.s->time() - run.d.time_step * now / (now - last));
        last = now;
    }
    ASSERT_GE(crossings.size(), 3u);
    const double m = run.d.templates[0].mass_properties.mass, inertia = 1.4 * m * radius * radius;
    const double stiffness = 2.25 * mu_r * mu_r * radius * radius * m * gravity / run.overlap, eta = run.d.physics.rolling_damping;
    const double period = 2.0 * M_PI * std::sqrt(inertia / stiffness) / std::sqrt(1.0 - eta * eta);
    // The tangential spring of the contact is in series with the rolling spring: it lengthens the period by some percent.
    figure_relative("Ai et al. 2011 test A, type C", "period at rest [s]", period, 2.0 * (crossings[2] - crossings[0]) / 2.0, 5e-2);
    run.s->advance(100000);
    figure_below("Ai et al. 2011 test A, type C", "kinetic energy left / first", run.kinetic() / start, 1e-12);
}

TEST(Rolling, BallOnAnInclineRestsIfAndOnlyIfTheSlopeIsBelowMuR) {
    const double mu_r = 0.2;
    for (const double slope : {0.15, 0.25}) {
        const double angle = std::atan(slope);
        BallOnPlane run(RollingModel::elastic_plastic, mu_r, angle, 0.0, 0.0);
        run.s->advance(50000);
        if (slope < mu_r) {
            figure_below("Ai et al. 2011 test B, tan a = 0.75 mu_r", "speed [m/s]", std::abs(run.speed()), 1e-6);
        } else {
            const double v = run.speed();
            run.s->advance(20000);
            figure_relative("Ai et al. 2011 test B, tan a = 1.25 mu_r", "acceleration [m/s²]", 5.0 / 7.0 * gravity * (std::sin(angle) - mu_r * std::cos(angle)),
                            (run.speed() - v) / 0.2, 5e-3);
        }
    }
}

}  // namespace
}  // namespace pelletlab::solver
