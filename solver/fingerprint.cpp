// What a checkpoint must agree with: everything in a definition that decides the future.
#include "solver/detail/state.hpp"

namespace pelletlab::solver {

namespace detail {

std::uint64_t fingerprint(const SimulationDefinition& d) {
    Hash hash;
    for (const RigidTemplate& t : d.templates) {
        hash.add(static_cast<std::uint64_t>(t.spheres.size()));
        for (const Sphere& s : t.spheres) hash.add(s.centre), hash.add(s.radius);
        hash.add(t.mass_properties.mass);
        hash.add(t.mass_properties.principal_inertia);
    }
    const auto add_material = [&](const ElasticMaterial& m) { hash.add(m.shear_modulus), hash.add(m.poisson_ratio); };
    const auto add_contact = [&](const PairParameters& p) {
        for (const double x : {p.restitution, p.sliding_friction, p.rolling_friction, p.kinetic_friction_ratio, p.relaxation_time, p.attraction_force,
                               p.cohesion_energy_density, p.work_of_adhesion})
            hash.add(x);
    };
    const Physics& p = d.physics;
    for (const auto choice : {static_cast<int>(p.contact), static_cast<int>(p.rolling), static_cast<int>(p.cohesion), static_cast<int>(p.clump_contacts)})
        hash.add(static_cast<std::uint64_t>(choice));
    for (const double x : {p.linear_stiffness, p.rolling_damping, p.rolling_damping_sliding, p.friction_decay_speed, p.liquid.surface_tension,
                           p.liquid.contact_angle, p.liquid.bridge_volume})
        hash.add(x);
    add_material(d.pellet_material);
    add_contact(d.pellet_contact);
    for (const WallDefinition& w : d.walls) {
        hash.add(w.name);
        hash.add(static_cast<std::uint64_t>(w.mesh.vertices.size()));
        for (const Vec3& v : w.mesh.vertices) hash.add(v);
        hash.add(static_cast<std::uint64_t>(w.mesh.faces.size()));
        for (const Triangle& f : w.mesh.faces)
            for (const std::uint32_t v : f) hash.add(std::uint64_t{v});
        add_material(w.material);
        add_contact(w.contact);
        hash.add(w.feature_angle);
        hash.add(static_cast<std::uint64_t>(w.exact.kind));
        hash.add(w.exact.point), hash.add(w.exact.axis), hash.add(w.exact.half_size);
        for (const double x : {w.exact.start.x(), w.exact.start.y(), w.exact.end.x(), w.exact.end.y()}) hash.add(x);
    }
    hash.add(d.gravity);
    hash.add(d.body_forces.air.density), hash.add(d.body_forces.air.viscosity), hash.add(d.body_forces.attraction);
    hash.add(d.time_step);
    return hash.value();
}

}  // namespace detail

}  // namespace pelletlab::solver
