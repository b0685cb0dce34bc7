#include "packing/run_frames.hpp"

#include <limits>

#include "core/error.hpp"

namespace pelletlab::packing {

namespace {

const Material& material_of(const Case& c, const std::string& name) {
    const auto found = c.materials.find(name);
    if (found == c.materials.end()) throw bad_input("the material '" + name + "' is not defined", "add a table [materials." + name + "] to the case");
    return found->second;
}

solver::ElasticMaterial elastic(const Material& material) {
    return {material.shear_modulus, material.poisson_ratio};
}

solver::PairParameters pair(const ContactParameters& contact) {
    return {contact.restitution,     contact.sliding_friction, contact.rolling_friction,        contact.kinetic_friction_ratio,
            contact.relaxation_time, contact.attraction_force, contact.cohesion_energy_density, contact.work_of_adhesion};
}

/// Index of a word in the order of the solver's enumeration.
template <class Choice>
Choice choice(const std::string& key, const std::string& word, const std::vector<std::string>& words) {
    for (std::size_t k = 0; k < words.size(); ++k)
        if (words[k] == word) return static_cast<Choice>(k);
    throw bad_input("physics." + key + " = \"" + word + "\" is not known", "see docs/case-reference.md");
}

solver::Physics physics_of(const PhysicsChoice& p) {
    solver::Physics physics;
    physics.contact = choice<solver::ContactModel>("contact_model", p.contact_model, {"hertz_edem", "hertz_impulse_exact", "linear", "viscoelastic"});
    physics.rolling = choice<solver::RollingModel>("rolling_model", p.rolling_model, {"constant_torque", "viscous", "elastic_plastic"});
    physics.cohesion = choice<solver::Cohesion>("cohesion", p.cohesion, {"none", "constant_force", "sjkr", "jkr", "capillary"});
    physics.clump_contacts = choice<solver::ClumpPolicy>("clump_contacts", p.clump_contacts, {"sum", "shared"});
    physics.linear_stiffness = p.linear_stiffness;
    physics.rolling_damping = p.rolling_damping;
    physics.rolling_damping_sliding = p.rolling_damping_sliding;
    physics.friction_decay_speed = p.friction_decay_speed;
    physics.liquid = {p.liquid_surface_tension, p.liquid_contact_angle, p.liquid_bridge_volume};
    physics.energy_book = p.energy_book;
    return physics;
}

/// The same body of the same density, all lengths times `factor`: volume and mass grow with its cube, moments of inertia with its fifth power.
RigidTemplate scaled(RigidTemplate body, double factor) {
    for (Sphere& sphere : body.spheres) {
        sphere.centre *= factor;
        sphere.radius *= factor;
    }
    const double cube = factor * factor * factor;
    MassProperties& properties = body.mass_properties;
    properties.volume *= cube;
    properties.mass *= cube;
    properties.principal_inertia *= cube * factor * factor;
    properties.centre_of_mass_mesh *= factor;
    return body;
}

}  // namespace

solver::SimulationDefinition define_simulation(const Case& c, const RunInputs& inputs, std::vector<solver::WallDefinition> walls) {
    const Material& material = material_of(c, c.pellet.material);
    const auto contact = c.contacts.find("pellet-pellet");
    if (contact == c.contacts.end()) throw bad_input("the contact 'pellet-pellet' is not defined", "add a table [contacts.pellet-pellet] to the case");
    RigidTemplate pellet = inputs.clump.rigid;
    if (pellet.spheres.empty() || !(pellet.mass_properties.density > 0.0) || !(pellet.mass_properties.volume > 0.0))
        throw bad_input("the clump '" + pellet.name + "' has no spheres, volume or density", "make it again with: pelletlab shape");
    pellet = scaled(std::move(pellet), c.pellet.size_factor);
    pellet.mass_properties = with_density(pellet.mass_properties, material.density);
    pellet.bounding_radius = bounding_radius(pellet.spheres);

    solver::SimulationDefinition definition;
    definition.templates = {std::move(pellet)};
    definition.pellet_material = elastic(material);
    definition.pellet_contact = pair(contact->second);
    definition.walls = std::move(walls);
    definition.gravity = c.gravity;
    definition.time_step = c.time.step;
    definition.physics = physics_of(c.physics);
    definition.body_forces.air.density = c.physics.air_density;
    definition.body_forces.air.viscosity = c.physics.air_viscosity;
    definition.body_forces.attraction = c.physics.attraction;
    return definition;
}

solver::WallDefinition define_wall(const Case& c, std::string name, TriangleMesh mesh, const std::string& material) {
    auto contact = c.contacts.find("pellet-" + name);
    if (contact == c.contacts.end()) contact = c.contacts.find("pellet-" + material);
    if (contact == c.contacts.end())
        throw bad_input("no contact is defined between the pellets and the wall '" + name + "' of material '" + material + "'",
                        "add a table [contacts.pellet-" + name + "] or [contacts.pellet-" + material + "] to the case");
    solver::WallDefinition wall;
    wall.name = std::move(name);
    wall.mesh = std::move(mesh);
    wall.material = elastic(material_of(c, material));
    wall.contact = pair(contact->second);
    wall.motion.frequency = c.physics.vibration_frequency;
    wall.motion.oscillation = c.physics.vibration_amplitude;
    return wall;
}

Frame capture_frame(const solver::Simulation& simulation, std::size_t in_all) {
    const solver::BodyState& bodies = simulation.bodies();
    Frame frame{simulation.time(), bodies.position, bodies.orientation, bodies.velocity, bodies.spin, simulation.wall_poses()};
    if (bodies.size() >= in_all) return frame;
    const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    frame.positions.resize(in_all, nowhere);
    frame.orientations.resize(in_all, Quat::Identity());
    frame.velocities.resize(in_all, nowhere);
    frame.spins.resize(in_all, nowhere);
    return frame;
}

TrajectoryHeader trajectory_header(const Case& c, const RunInputs& inputs, const solver::Simulation& simulation) {
    TrajectoryHeader header;
    header.case_name = c.name;
    TriangleMesh surface = inputs.pellet_surface_body;
    for (Vec3& vertex : surface.vertices) vertex *= c.pellet.size_factor;
    for (const RigidTemplate& pellet : simulation.definition().templates) header.shapes.push_back({pellet, surface});
    header.shape_of_body = simulation.bodies().template_index;
    for (const solver::WallDefinition& wall : simulation.definition().walls) header.walls.push_back({wall.name, wall.mesh});
    header.gravity = c.gravity;
    header.resolved_case = inputs.resolved_case;
    header.provenance = inputs.provenance;
    return header;
}

}  // namespace pelletlab::packing
