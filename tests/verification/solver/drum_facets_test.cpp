// Round walls cut into facets against the exact cylinder, and against the polygon that they are: torque and forces of a drum.
#include <algorithm>

#include "drum_scene.hpp"
#include "figure.hpp"
#include "rigid_sledge.hpp"

namespace pelletlab::solver {
namespace {

using scene::drum_title;
using verification::figure_relative;

constexpr double gravity = 9.81;

/// A sledge of four runners (arms ± b along x, ± c along the axis, a height h below its centre of mass) slides in the turning drum: nothing in it is chaotic.
struct Sledge {
    double big_r = 0.05, r = 1.5e-3, b = 12e-3, c = 4e-3, h = 2e-3, mu = 0.3, speed = 1.0;

    RigidTemplate body() const {
        RigidTemplate t;
        t.name = "sledge";
        for (const double x : {-b, b})
            for (const double y : {-c, c}) t.spheres.push_back({{x, y, -h}, r});
        MassProperties& m = t.mass_properties;
        m.volume = 1e-6, m.density = 2000.0, m.mass = 2e-3;
        m.principal_inertia = m.mass * Vec3(c * c + h * h, b * b + h * h, b * b + c * c);
        t.bounding_radius = bounding_radius(t.spheres);
        return t;
    }
    /// Centre of mass from the axis, and half the angle between the runners as seen from the axis.
    double distance() const { return std::sqrt((big_r - r) * (big_r - r) - b * b) - h; }
    double half_angle() const { return std::asin(b / (big_r - r)); }

    /// Balance of forces across and along, and of torques about the axis, with S the sum of the normal forces and D that of the leading runners less that of
    /// the trailing ones:  S cos β + μ D sin β = m g cos φ,  μ S cos β − D sin β = m g sin φ,  μ R S = m g d sin φ  ⇒
    ///   tan φ = μ R / (d (1 + μ²) cos β − μ² R),  torque = m g d sin φ.
    double torque() const {
        const double tangent = mu * big_r / (distance() * (1.0 + mu * mu) * std::cos(half_angle()) - mu * mu * big_r);
        return body().mass_properties.mass * gravity * distance() * std::sin(std::atan(tangent));
    }
};

struct SledgeRun {
    double torque = 0.0, weight = 0.0;  ///< mean over whole facets
    std::size_t most_contacts = 0;
};

/// Mean over `whole_facets` facets; of the exact cylinder over 0.2 s.
SledgeRun slide(const Sledge& sledge, int facets, int whole_facets, double rest, double feature_angle = M_PI / 6.0) {
    SimulationDefinition d;
    d.templates = {sledge.body()};
    d.pellet_material = {2e8, 0.25};
    d.walls = {scene::drum_shell(sledge.big_r, 0.03, facets, {0.2, sledge.mu, 0.0}, sledge.speed)};
    d.walls[0].material = {2e8, 0.25}, d.walls[0].feature_angle = feature_angle;
    d.physics.contact = ContactModel::hertz_impulse_exact;
    d.time_step = 2e-6;
    Simulation s(d);
    BodyPlacement b;
    const double phi = std::asin(sledge.torque() / (sledge.body().mass_properties.mass * gravity * sledge.distance()));
    b.pose.orientation = Quat(Eigen::AngleAxisd(phi, Vec3::UnitY()));  // positive rotation of the drum takes the bottom to −x
    b.pose.position = Vec3(-std::sin(phi), 0.0, -std::cos(phi)) * (sledge.distance() - (facets > 0 ? 0.01 * sledge.big_r : 1e-6));
    s.add_bodies({&b, 1});
    const double turn = 2.0 * M_PI / sledge.speed;
    const auto steps = [&](double time) { return static_cast<std::uint64_t>(std::llround(time / d.time_step)); };
    s.advance(steps(rest));
    SledgeRun run;
    const std::uint64_t count = steps(facets > 0 ? turn / facets * whole_facets : 0.2);
    for (std::uint64_t k = 0; k < count; ++k) {
        s.step();
        run.torque -= s.wall_loads()[0].torque.y() / static_cast<double>(count);
        run.weight -= s.wall_loads()[0].force.z() / static_cast<double>(count);
        if (k % 100 == 0) run.most_contacts = std::max(run.most_contacts, s.contacts().wall_contacts);
    }
    return run;
}

/// The same sledge, rigid, in a rigid polygon: nothing in common with the solver but the laws of Newton and Coulomb.
verification::RigidSledge rigid(const Sledge& sledge, int facets) {
    verification::RigidSledge s;
    s.mass = sledge.body().mass_properties.mass, s.inertia = sledge.body().mass_properties.principal_inertia.y();
    s.b = sledge.b, s.h = sledge.h, s.r = sledge.r;
    s.apothem = scene::corner_radius(sledge.big_r, facets) * std::cos(M_PI / facets);
    s.facets = facets, s.speed = sledge.speed, s.friction = sledge.mu, s.restitution = 0.2, s.gravity = gravity;
    return s;
}

/// Facets that are averaged over, after a second in which the sledge finds its way of going.
int counted(int facets) {
    return std::clamp(facets / 4, 6, 400);
}

TEST(DrumFacets, ASledgeFeelsTheTorqueOfTheCylinder) {
    const Sledge sledge;
    const double weight = sledge.body().mass_properties.mass * gravity;
    // 24 facets are no circle to a sledge: they make 3 to 4 % more torque, as the next test derives. From 48 facets on half a percent is asked for.
    for (const int facets : {0, 24, 48, 120, 480, 1200, 4800}) {
        const SledgeRun run = slide(sledge, facets, counted(facets), 1.0);
        figure_relative(drum_title("Sledge in a turning drum", facets), "mean torque [N m]", sledge.torque(), run.torque, facets == 24 ? 4.5e-2 : 5e-3);
        figure_relative(drum_title("Sledge in a turning drum", facets), "mean wall force [N]", weight, run.weight, 5e-3);
        EXPECT_EQ(run.most_contacts, 4u) << facets;  // one contact a runner, whatever the seams
    }
}

TEST(DrumFacets, ASledgeFeelsTheTorqueOfThePolygon) {
    // The wall's torque is m g times the mean offset of the sledge. A facet of 24 turns by 15° while a runner crosses it, nearly the angle of friction (16.7°):
    // the sledge is carried up on it, starts to slide when the slope is as steep as friction holds, and needs a good part of the 0.26 s that a facet takes to
    // slide back, so it hangs further up in the mean than on a circle. Rigid bodies in a rigid polygon say how much: no spring, no mesh, no search. With every
    // facet a face of its own (a small feature angle) the solver's mesh is that polygon, with two contacts in a corner.
    const Sledge sledge;
    const double phi = std::asin(sledge.torque() / (sledge.body().mass_properties.mass * gravity * sledge.distance()));
    for (const int facets : {24, 48}) {
        const auto polygon = [&](double time_step) { return rigid(sledge, facets).mean_torque(phi, time_step, 1.0, counted(facets)); };
        const double expected = polygon(1e-4);
        EXPECT_NEAR(polygon(2e-4), expected, 1e-3 * expected) << "the referee's own step is too long";
        figure_relative(drum_title("Sledge in a turning drum", facets) + ", each a face of its own", "mean torque, of rigid bodies in a rigid polygon [N m]",
                        expected, slide(sledge, facets, counted(facets), 1.0, 0.05).torque, 2e-3);
    }
}

}  // namespace
}  // namespace pelletlab::solver
