// A bed of spheres in a drum of facets against the same bed in the exact cylinder: force by force at one instant, where nothing is left to chance, and over a
// short while, with the histories of the contacts, before chaos makes other beds of them.
#include <algorithm>
#include <map>

#include "drum_scene.hpp"
#include "figure.hpp"

namespace pelletlab::solver {
namespace {

using verification::figure;
using verification::figure_below;
using verification::figure_relative;

/// A bed, thin and between smooth exact planes that stand still, so that the shell alone drives it. It slides at the shell.
struct Bed {
    double big_r = 0.025, length = 0.010, r = 1.5e-3, speed = 3.0, wall_friction = 0.2, wall_restitution = 0.5;
    ElasticMaterial material{2e6, 0.25};
    int count = 300;

    SimulationDefinition definition(int facets, double phase = 0.0) const {
        SimulationDefinition d;
        d.templates = {scene::sphere_template(r, 1800.0)};
        d.pellet_contact = {0.5, 0.8, 0.1};
        d.pellet_material = material;
        d.walls = {scene::drum_shell(big_r, length, facets, {wall_restitution, wall_friction, 0.1}, speed, phase)};
        for (const double side : {-0.5, 0.5}) {
            WallDefinition end = scene::wall(side < 0.0 ? "front" : "back", {}, {0.5, 0.0, 0.0}, material);
            end.exact = exact_plane({0.0, side * length, 0.0}, Vec3::UnitY());
            d.walls.push_back(end);
        }
        d.time_step = 3e-5;
        return d;
    }
    std::vector<BodyPlacement> bodies() const {
        std::vector<BodyPlacement> all;
        const double spacing = 2.2 * r;
        for (int row = 0; static_cast<int>(all.size()) < count; ++row) {
            const double z = -0.92 * big_r + r + row * spacing, half = std::sqrt(std::max(0.0, std::pow(0.96 * big_r - r, 2) - z * z));
            const int columns = 1 + static_cast<int>(2.0 * half / spacing);
            for (int k = 0; k < 3 * columns && static_cast<int>(all.size()) < count; ++k) {
                RandomStream random(8, all.size());
                BodyPlacement b;
                b.pose.position = {(k / 3 - 0.5 * (columns - 1)) * spacing, (k % 3 - 1) * spacing * 0.98, z};
                b.velocity = Vec3(random.normal(), random.normal(), random.normal()) * 0.05;
                all.push_back(b);
            }
        }
        return all;
    }
    double weight() const { return count * definition(0).templates[0].mass_properties.mass * 9.81; }
};

// ---- one instant ----

/// Places, velocities and spins of a bed that has turned for a while; tangential histories begin anew.
std::vector<BodyPlacement> snapshot(const Bed& bed, double time) {
    Simulation s(bed.definition(4800));
    s.add_bodies(bed.bodies());
    s.advance(static_cast<std::uint64_t>(std::llround(time / s.definition().time_step)));
    std::vector<BodyPlacement> all(s.bodies().size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = {0, {s.bodies().position[i], s.bodies().orientation[i]}, s.bodies().velocity[i], s.bodies().spin[i]};
    return all;
}

/// What the shell does to the bed one step after the snapshot.
struct Instant {
    BodyState bodies;
    std::map<std::uint32_t, ContactPoint> shell;  ///< by body
    double torque = 0.0, force = 0.0;             ///< [N m], [N] downwards, on the shell
    double turned = 0.0;                          ///< [rad]
};

Instant one_step(const Bed& bed, const std::vector<BodyPlacement>& bodies, int facets, double phase = 0.0) {
    Simulation s(bed.definition(facets, phase));
    s.add_bodies(bodies, 0.5);
    s.step();
    Instant now;
    now.bodies = s.bodies();
    for (const ContactPoint& c : s.contact_points())
        if (c.wall == 0) {
            EXPECT_TRUE(now.shell.emplace(c.body_i, c).second) << "two contacts of one sphere with a smooth shell";
        }
    now.torque = -s.wall_loads()[0].torque.y(), now.force = -s.wall_loads()[0].force.z();
    now.turned = bed.speed * s.time();
    return now;
}

/// Distance from the polygon's nearest facet: what a mesh of it must find [m].
double distance_to_facet(const Bed& bed, const Vec3& p, int facets, double turned) {
    const double width = 2.0 * M_PI / facets, apothem = scene::corner_radius(bed.big_r, facets) * std::cos(0.5 * width);
    // A turn about +y takes z to x: angles from x towards −z grow with it. Facet k lies about the angle (k + ½) width.
    const double angle = std::atan2(-p.z(), p.x()) - turned;
    const double middle = (std::floor(angle / width) + 0.5) * width + turned;
    const Vec3 out(std::cos(middle), 0.0, -std::sin(middle));
    return apothem - p.dot(out);
}

TEST(DrumBed, AnInstantOfAMovingBedFeels4800FacetsAsTheCylinder) {
    const Bed bed;
    constexpr int facets = 4800;
    const std::vector<BodyPlacement> bodies = snapshot(bed, 0.5);
    const Instant exact = one_step(bed, bodies, 0), mesh = one_step(bed, bodies, facets);
    ASSERT_GT(exact.shell.size(), 40u);
    EXPECT_GT(exact.torque, 0.0);

    // Geometry: each overlap is that with the polygon's nearest facet in closed form, and lies within the polygon's corner excess of the cylinder's. A sphere
    // touches some twenty of these facets; its one contact with the smooth patch points somewhere between their normals.
    const double tilt = M_PI / facets, excess = scene::corner_radius(bed.big_r, facets) - bed.big_r;
    double worst_overlap = 0.0, worst_excess = 0.0, worst_tilt = 0.0, worst_share = 0.0;
    const double modulus = bed.material.shear_modulus / (1.0 - bed.material.poisson_ratio);  // E* of two equal materials: E / (2 (1 − ν²)), E = 2 G (1 + ν)
    const double modulus_t = bed.material.shear_modulus / (2.0 * (2.0 - bed.material.poisson_ratio));  // G*
    const double mass = bed.definition(0).templates[0].mass_properties.mass, log_e = std::log(bed.wall_restitution);
    const double damping = 2.0 * std::sqrt(5.0 / 6.0) * -log_e / std::sqrt(log_e * log_e + M_PI * M_PI), dt = bed.definition(0).time_step;
    for (const auto& [body, with_cylinder] : exact.shell) {
        const auto found = mesh.shell.find(body);
        if (found == mesh.shell.end()) {
            EXPECT_LT(with_cylinder.overlap, excess) << "a contact that the facets lose";
            continue;
        }
        const ContactPoint& with_mesh = found->second;
        const double distance = distance_to_facet(bed, mesh.bodies.position[body], facets, mesh.turned);
        worst_overlap = std::max(worst_overlap, std::abs(with_mesh.overlap - (bed.r - distance)));
        worst_excess = std::max(worst_excess, std::abs(with_mesh.overlap - with_cylinder.overlap) / excess);
        worst_tilt = std::max(worst_tilt, (with_mesh.normal - with_cylinder.normal).norm() / tilt);

        // Forces: the law is continuous, so a change of the overlap by the excess and of the normal by the tilt bounds the change of force:
        //   |ΔF| ≤ (1 + μ) (S_n Δd + c_n |v| Δn) + (c_t + 2 S_t Δt) |v| Δn + |F| Δn,   v the sphere's velocity against the wall there, histories two steps
        //   long.
        const Vec3 spot = exact.bodies.position[body] - bed.r * with_cylinder.normal;
        const Vec3 v = exact.bodies.velocity[body] + exact.bodies.spin[body].cross(-bed.r * with_cylinder.normal) - bed.speed * Vec3::UnitY().cross(spot);
        const double root = std::sqrt(bed.r * std::max(with_cylinder.overlap, with_mesh.overlap)), s_n = 2.0 * modulus * root, s_t = 8.0 * modulus_t * root;
        const double c_n = damping * std::sqrt(s_n * mass), c_t = damping * std::sqrt(s_t * mass), elastic = 2.0 / 3.0 * s_n * root * root / bed.r;
        const double most = (1.0 + bed.wall_friction) * (s_n * excess + c_n * v.norm() * tilt) + (c_t + 2.0 * s_t * dt) * v.norm() * tilt +
                            (1.0 + bed.wall_friction) * (elastic + c_n * v.norm()) * tilt;
        worst_share = std::max(worst_share, (exact.bodies.force[body] - mesh.bodies.force[body]).norm() / most);
    }
    for (const auto& [body, with_mesh] : mesh.shell)
        if (!exact.shell.contains(body)) {
            EXPECT_LT(with_mesh.overlap, excess) << "a contact that the cylinder does not have";
        }
    const std::string name = "Instant of a moving bed of 300 spheres, 4800 facets";
    figure_below(name, "overlap against that of the polygon's facet / sphere radius", worst_overlap / bed.r, 1e-10);
    figure_below(name, "overlap against the exact cylinder's / corner excess of the polygon", worst_excess, 1.001);
    figure_below(name, "normal against the exact cylinder's / half angle of a facet", worst_tilt, 1.001);
    figure_below(name, "force on a sphere against the exact cylinder's / what excess and tilt allow", worst_share, 1.0);

    // A facet tilts to one side as often as to the other: in the mean over a facet's width nothing is left but what is of second order in the tilt.
    constexpr int phases = 32;
    double torque = 0.0, force = 0.0;
    for (int k = 0; k < phases; ++k) {
        const Instant turned = one_step(bed, bodies, facets, 2.0 * tilt * k / phases);
        torque += turned.torque / phases, force += turned.force / phases;
    }
    figure_relative(name, "torque, mean over where the facets' corners lie [N m]", exact.torque, torque, 1e-4);
    figure_relative(name, "wall force, mean over where the facets' corners lie [N]", exact.force, force, 1e-4);
}

// ---- a short while ----

/// Mean torque and force on the shell over so many steps from the snapshot on, every bed's velocities changed by some 1e-6 m/s.
std::pair<double, double> mean_loads(const Bed& bed, std::vector<BodyPlacement> bodies, int facets, double phase, int steps, std::uint64_t seed) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        RandomStream random(seed, i);
        bodies[i].velocity += 1e-6 * Vec3(random.normal(), random.normal(), random.normal());
    }
    Simulation s(bed.definition(facets, phase));
    s.add_bodies(bodies, 0.5);
    double torque = 0.0, force = 0.0;
    for (int k = 0; k < steps; ++k) {
        s.step();
        torque -= s.wall_loads()[0].torque.y() / steps, force -= s.wall_loads()[0].force.z() / steps;
    }
    return {torque, force};
}

TEST(DrumBed, AShortWhileOfAMovingBedFeels4800FacetsAsTheCylinder) {
    // With the histories of the contacts: in 9 ms the bed slides over some twenty facets, and chaos has not yet made other beds of the pairs that began alike.
    const Bed bed;
    constexpr int facets = 4800, runs = 8, steps = 300;
    const double width = 2.0 * M_PI / facets;
    double ratio = 0.0, squares = 0.0, force = 0.0;
    int pairs = 0;
    for (const double time : {0.4, 0.5}) {
        const std::vector<BodyPlacement> bodies = snapshot(bed, time);
        for (int k = 0; k < runs; ++k, ++pairs) {
            const auto seed = static_cast<std::uint64_t>(100 + k);
            const auto exact = mean_loads(bed, bodies, 0, 0.0, steps, seed), mesh = mean_loads(bed, bodies, facets, width * k / runs, steps, seed);
            const double r = mesh.first / exact.first;
            ratio += r, squares += r * r, force += mesh.second / exact.second;
        }
    }
    ratio /= pairs, force /= pairs;
    const double error = std::sqrt((squares / pairs - ratio * ratio) / (pairs - 1));
    char text[100];
    std::snprintf(text, sizeof text, "torque / exact cylinder's − 1, ± %.1g (standard error of %d pairs)", error, pairs);
    EXPECT_LT(error, 3e-5);
    const std::string name = "9 ms of a moving bed of 300 spheres, 4800 facets";
    figure(name, text, 0.0, ratio - 1.0, 1e-4);
    figure(name, "wall force / exact cylinder's − 1", 0.0, force - 1.0, 1e-4);
}

}  // namespace
}  // namespace pelletlab::solver
