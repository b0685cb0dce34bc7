#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "io/case_file.hpp"
#include "io/detail/case_key_makers.hpp"
#include "io/detail/case_keys.hpp"

namespace pelletlab::io::detail {

namespace {

/// Contact parameters of laws that are not the study's.
template <class Add>
void add_physics_of_contacts(const Add& add) {
    using namespace dimension;
    add(optional(
        within(from_to(0, 1), key("contacts.*.kinetic_friction_ratio", PELLETLAB_MEMBER(c.contacts.at(name).kinetic_friction_ratio),
                                  "Kinetic / static friction: falls with the sliding speed v as 1 / (1 + v / physics.friction_decay_speed); 1: constant."))));
    add(optional(in(time, "us",
                    within(from(0), key("contacts.*.relaxation_time", PELLETLAB_MEMBER(c.contacts.at(name).relaxation_time),
                                        "Dissipation of physics.contact_model = \"viscoelastic\", which takes the place of restitution.")))));
    add(optional(in(force, "mN",
                    within(from(0), key("contacts.*.attraction_force", PELLETLAB_MEMBER(c.contacts.at(name).attraction_force),
                                        "Pull of every touching contact, of physics.cohesion = \"constant_force\".")))));
    add(optional(in(pressure, "kPa",
                    within(from(0), key("contacts.*.cohesion_energy_density", PELLETLAB_MEMBER(c.contacts.at(name).cohesion_energy_density),
                                        "Pull per contact area (J/m^3 = Pa), of physics.cohesion = \"sjkr\".")))));
    add(optional(in(surface_energy, "J/m^2",
                    within(from(0), key("contacts.*.work_of_adhesion", PELLETLAB_MEMBER(c.contacts.at(name).work_of_adhesion),
                                        "Work of adhesion, twice the surface energy, of physics.cohesion = \"jkr\".")))));
}

/// Laws and forces; the defaults are the study's.
template <class Add>
void add_physics(const Add& add) {
    using namespace dimension;
    add(word({"hertz_edem", "hertz_impulse_exact", "linear", "viscoelastic"}, key("physics.contact_model", PELLETLAB_MEMBER(c.physics.contact_model),
                                                                                  "Hertz-Mindlin as in EDEM, Hertz-Mindlin that never pulls and returns with "
                                                                                  "the exact restitution, linear spring-dashpot, or viscoelastic spheres.")));
    add(word({"constant_torque", "viscous", "elastic_plastic"},
             key("physics.rolling_model", PELLETLAB_MEMBER(c.physics.rolling_model), "Rolling friction of type A, B or C (EPSD) of Ai et al. 2011.")));
    add(word({"none", "constant_force", "sjkr", "jkr", "capillary"},
             key("physics.cohesion", PELLETLAB_MEMBER(c.physics.cohesion), "Attraction of touching pellets; jkr and capillary hold beyond touching.")));
    add(word({"sum", "shared"}, key("physics.clump_contacts", PELLETLAB_MEMBER(c.physics.clump_contacts),
                                    "Every sphere contact of two pellets counts in full, or they share the load of one contact.")));
    add(in(surface_energy, "N/m",
           within(above(0),
                  key("physics.linear_stiffness", PELLETLAB_MEMBER(c.physics.linear_stiffness), "Normal stiffness of every contact of the linear model."))));
    add(within(from_to(0, 2),
               key("physics.rolling_damping", PELLETLAB_MEMBER(c.physics.rolling_damping), "Share of critical damping of elastic_plastic rolling.")));
    add(within(from_to(0, 1), key("physics.rolling_damping_sliding", PELLETLAB_MEMBER(c.physics.rolling_damping_sliding),
                                  "Part of that damping that stays when the full rolling torque acts.")));
    add(in(velocity, "m/s",
           within(above(0), key("physics.friction_decay_speed", PELLETLAB_MEMBER(c.physics.friction_decay_speed),
                                "Sliding speed at which friction has fallen half way to its kinetic value."))));
    add(in(
        surface_energy, "N/m",
        within(from(0), key("physics.liquid_surface_tension", PELLETLAB_MEMBER(c.physics.liquid_surface_tension), "Surface tension of capillary bridges."))));
    add(in(angle, "deg",
           within({0.0, 1.5707963267948966, false, true},
                  key("physics.liquid_contact_angle", PELLETLAB_MEMBER(c.physics.liquid_contact_angle), "Contact angle of capillary bridges."))));
    add(in(volume, "mm^3",
           within(above(0), key("physics.liquid_bridge_volume", PELLETLAB_MEMBER(c.physics.liquid_bridge_volume), "Liquid in every capillary bridge."))));
    add(in(density, "kg/m^3",
           within(from(0), key("physics.air_density", PELLETLAB_MEMBER(c.physics.air_density),
                               "Still air that drags at the pellets (Schiller & Naumann, on the sphere of the pellet's volume); 0: none."))));
    add(in(viscosity, "Pa*s", within(above(0), key("physics.air_viscosity", PELLETLAB_MEMBER(c.physics.air_viscosity), "Dynamic viscosity of that air."))));
    add(in(acceleration, "m/s^2", key("physics.attraction", PELLETLAB_MEMBER(c.physics.attraction), "Uniform attraction beside gravity, per mass.")));
    add(in(frequency, "Hz",
           within(from(0), key("physics.vibration_frequency", PELLETLAB_MEMBER(c.physics.vibration_frequency), "Vibration of all walls; 0: none."))));
    add(in(length, "mm", key("physics.vibration_amplitude", PELLETLAB_MEMBER(c.physics.vibration_amplitude), "Amplitude of that vibration, world axes.")));
    add(key("physics.energy_book", PELLETLAB_MEMBER(c.physics.energy_book),
            "Keep count of elastic energy and of what each mechanism dissipates (costs some speed)."));
}

std::vector<CaseKey> make_keys() {
    using namespace dimension;
    std::vector<CaseKey> keys;
    const auto add = [&keys](CaseKey k) { keys.push_back(std::move(k)); };

    add(one_of({"tube", "drum", "pile", "tester"}, key("rig", PELLETLAB_MEMBER(c.rig), "Apparatus of the run.")));
    add(key("name", PELLETLAB_MEMBER(c.name), "Name of the run in results and pictures."));
    // TOML's whole numbers end at 2^63 − 1; the limit below is the largest double under it, so a seed can always be written back.
    add(within(from_to(0, 9223372036854774784.0), key("seed", PELLETLAB_MEMBER(c.seed), "Seed of all random numbers; the same seed gives the same bits.")));
    add(in(acceleration, "m/s^2", key("gravity", PELLETLAB_MEMBER(c.gravity), "Gravity in world axes (x, y, z); z points up.")));

    add(key("pellet.clump_file", PELLETLAB_MEMBER(c.pellet.clump_file),
            "Clump template, made by `pelletlab shape`; a relative path starts at the folder of the case file."));
    add(within(from_to(0, 100e6),
               key("pellet.count", PELLETLAB_MEMBER(c.pellet.count), "Number of pellets; 0 in a drum: as many as drum.fill_fraction asks for.")));
    add(within(between(0.1, 10), key("pellet.size_factor", PELLETLAB_MEMBER(c.pellet.size_factor),
                                     "All lengths of the pellet / those of the clump file: 1.03 is 3 % longer and wider, at the same density.")));
    add(key("pellet.material", PELLETLAB_MEMBER(c.pellet.material), "Material of the pellets: a table [materials.<name>]."));

    add(in(density, "kg/m^3",
           within(above(0), key("materials.*.density", PELLETLAB_MEMBER(c.materials.at(name).density), "Density; the pellet's decides its mass."))));
    add(in(pressure, "MPa",
           within(above(0), key("materials.*.shear_modulus", PELLETLAB_MEMBER(c.materials.at(name).shear_modulus),
                                "Shear modulus; softer pellets allow longer time steps and overlap more."))));
    add(within(between(-1, 0.5), key("materials.*.poisson_ratio", PELLETLAB_MEMBER(c.materials.at(name).poisson_ratio), "Poisson's ratio.")));

    add(within(above_to(0, 1),
               key("contacts.*.restitution", PELLETLAB_MEMBER(c.contacts.at(name).restitution), "Coefficient of restitution of a normal impact.")));
    add(within(from(0),
               key("contacts.*.sliding_friction", PELLETLAB_MEMBER(c.contacts.at(name).sliding_friction), "Coulomb's coefficient of sliding friction.")));
    add(within(from(0), key("contacts.*.rolling_friction", PELLETLAB_MEMBER(c.contacts.at(name).rolling_friction), "Coefficient of rolling friction.")));
    add_physics_of_contacts(add);
    add_physics(add);

    add(in(length, "mm", within(above(0), key("tube.diameter", PELLETLAB_MEMBER(c.tube.diameter), "Inner diameter."))));
    add(in(length, "mm", within(from(0), key("tube.height", PELLETLAB_MEMBER(c.tube.height), "Height; 0: high enough for the pellets to be inserted."))));
    add(key("tube.lying", PELLETLAB_MEMBER(c.tube.lying), "The axis lies level, along y: tube.height is the length between two end plates."));
    add(within(from_to(8, 4096), key("tube.facets", PELLETLAB_MEMBER(c.tube.facets), "Flat facets of the round shell.")));
    add(key("tube.mesh_file", PELLETLAB_MEMBER(c.tube.mesh_file), "Mesh of shell and floor to use instead of the round tube; empty: none."));
    add(key("tube.mesh_unit", PELLETLAB_MEMBER(c.tube.mesh_unit), "Length unit of mesh_file (an STL file does not tell): mm, m, in and so on."));
    add(key("tube.material", PELLETLAB_MEMBER(c.tube.material), "Material of shell and floor: a table [materials.<name>]."));
    add(word({"facets", "exact"}, key("tube.surface", PELLETLAB_MEMBER(c.tube.surface),
                                      "Pellets touch the facets, or the exact cylinder with its floor or end plates that they stand for.")));

    add(in(length, "mm", within(above(0), key("drum.diameter", PELLETLAB_MEMBER(c.drum.diameter), "Inner diameter."))));
    add(in(length, "mm", within(above(0), key("drum.length", PELLETLAB_MEMBER(c.drum.length), "Inner length between the end plates."))));
    add(in(rotation_speed, "rpm",
           key("drum.speed", PELLETLAB_MEMBER(c.drum.speed), "Speed of rotation; positive turns about +y: the bed climbs on the left, at x < 0.")));
    add(within(above_to(0, 1),
               key("drum.fill_fraction", PELLETLAB_MEMBER(c.drum.fill_fraction), "Bulk volume of the bed / volume of the drum; used when pellet.count is 0.")));
    add(within(above_to(0, 1), key("drum.bulk_packing_fraction", PELLETLAB_MEMBER(c.drum.bulk_packing_fraction),
                                   "Packing fraction that turns bulk volume into a number of pellets.")));
    add(within(from_to(8, 4096), key("drum.facets", PELLETLAB_MEMBER(c.drum.facets), "Flat facets of the round shell.")));
    add(key("drum.end_plates_rotate", PELLETLAB_MEMBER(c.drum.end_plates_rotate), "End plates turn with the shell, or stand still."));
    add(key("drum.mesh_file", PELLETLAB_MEMBER(c.drum.mesh_file), "Mesh to use instead of the round drum; empty: none."));
    add(key("drum.mesh_unit", PELLETLAB_MEMBER(c.drum.mesh_unit), "Length unit of mesh_file (an STL file does not tell): mm, m, in and so on."));
    add(key("drum.material", PELLETLAB_MEMBER(c.drum.material), "Material of shell and end plates: a table [materials.<name>]."));
    add(word({"facets", "exact"},
             key("drum.surface", PELLETLAB_MEMBER(c.drum.surface), "Pellets touch the facets, or the exact cylinder and end plates that they stand for.")));

    for (CaseKey& k : keys_of_piles_and_testers()) add(std::move(k));
    for (CaseKey& k : keys_of_extra_walls()) add(std::move(k));

    add(word({"cloud", "sieve", "batches", "funnel"},
             key("insertion.way", PELLETLAB_MEMBER(c.insertion.way),
                 "How a tube is filled: all pellets at once as a loose cloud, rain from a sieve, clouds one after the other, or through a funnel.")));
    add(within(above_to(0, 0.5), key("insertion.packing_fraction", PELLETLAB_MEMBER(c.insertion.packing_fraction),
                                     "Packing fraction of the loose cloud of pellets before they fall.")));
    add(in(velocity, "m/s",
           within(from(0), key("insertion.fall_speed", PELLETLAB_MEMBER(c.insertion.fall_speed), "Downward speed of the pellets at release."))));
    add(within(from_to(1, 1000), key("insertion.batches", PELLETLAB_MEMBER(c.insertion.batches),
                                     "Clouds of insertion.way = \"batches\"; each comes to rest before the next one falls.")));
    add(in(frequency, "Hz",
           within(above(0), key("insertion.sieve_rate", PELLETLAB_MEMBER(c.insertion.sieve_rate), "Pellets that leave the sieve per second."))));
    add(in(length, "mm",
           within(from(0), key("insertion.sieve_height", PELLETLAB_MEMBER(c.insertion.sieve_height),
                               "Height of the sieve above the floor; 0: twice the height that the bed will have, and 50 mm."))));
    add(within(from_to(0, 10000), key("insertion.taps", PELLETLAB_MEMBER(c.insertion.taps), "Taps of the tube once the bed is at rest.")));
    add(in(length, "mm", within(above(0), key("insertion.tap_amplitude", PELLETLAB_MEMBER(c.insertion.tap_amplitude), "How far a tap lifts the tube."))));
    add(in(frequency, "Hz", within(above(0), key("insertion.tap_frequency", PELLETLAB_MEMBER(c.insertion.tap_frequency), "Of the one swing that is a tap."))));

    add(in(time, "s", within(above_to(0, 0.1), key("time.step", PELLETLAB_MEMBER(c.time.step), "Time step."))));
    add(in(
        time, "s",
        within(above(0), key("time.settle_limit", PELLETLAB_MEMBER(c.time.settle_limit), "A bed that is not at rest by then gets the status «not at rest»."))));
    add(within(above(0), key("time.rest_kinetic_energy", PELLETLAB_MEMBER(c.time.rest_kinetic_energy),
                             "A bed is at rest when its kinetic energy per pellet is below this · m·g·d of a pellet.")));
    add(within(above_to(0, 1), key("time.rest_contact_change", PELLETLAB_MEMBER(c.time.rest_contact_change),
                                   "… and its number of touching pairs stays within this share of itself, both for 20 ms.")));
    add(in(time, "s", within(from(0), key("time.spin_up", PELLETLAB_MEMBER(c.time.spin_up), "Rotation before measuring (drum, tester)."))));
    add(in(time, "s", within(above(0), key("time.measure", PELLETLAB_MEMBER(c.time.measure), "Rotation that is measured (drum, tester)."))));

    add(in(time, "s", within(above(0), key("output.frame_interval", PELLETLAB_MEMBER(c.output.frame_interval), "Time between stored frames."))));
    add(key("output.paraview", PELLETLAB_MEMBER(c.output.paraview), "Write ParaView files."));
    add(within(from_to(1, 1e6),
               key("output.paraview_every", PELLETLAB_MEMBER(c.output.paraview_every), "ParaView gets each n-th stored frame, and the last.")));
    add(key("output.pictures", PELLETLAB_MEMBER(c.output.pictures), "Write PNG pictures."));
    add(key("output.picture_spheres", PELLETLAB_MEMBER(c.output.picture_spheres), "Draw the spheres of the clump instead of the pellet's true surface."));
    add(within(from_to(200, 16384), key("output.picture_width", PELLETLAB_MEMBER(c.output.picture_width), "Width of the pictures in pixels.")));

    add(in(
        length, "mm",
        within(above(0), key("measurement.height_grid", PELLETLAB_MEMBER(c.measurement.height_grid), "Cell of the grid over the top surface (tube, pile)."))));
    add(in(length, "mm",
           within(above(0),
                  key("measurement.velocity_grid", PELLETLAB_MEMBER(c.measurement.velocity_grid), "Cell of the maps over the end view (drum, tester)."))));
    return keys;
}

std::vector<CaseSection> make_sections() {
    return {
        {{}, "The run."},
        {{"pellet"}, "Which pellets, and how many."},
        {{"materials", "*"},
         "Elastic constants and density of a material. `pellet` and `vessel` have the defaults of Marigo & Stitt 2015, Table 1 (Perspex with "
         "ν = 0.25); a material of another name states all its keys."},
        {{"contacts", "*"},
         "Contact parameters of `pellet-pellet`, and of pellets with a wall: `pellet-<wall name>`, else `pellet-<material of the wall>`. "
         "`pellet-pellet` and `pellet-vessel` have the defaults of run 12 in Table 4 of the same study; other rows state restitution and both frictions."},
        {{"physics"}, "Laws of contact and forces on pellets; the defaults are the study's."},
        {{"tube"}, "Vertical tube: axis z, floor at z = 0. Lying: axis y, centre in the origin."},
        {{"drum"}, "Horizontal drum: axis y, centre in the origin."},
        {{"pile"}, "Pile on a plate: z = 0, poured about the z axis."},
        {{"funnel"}, "Funnel with a shutter, about the z axis: of a pile with release = \"funnel\" and of a tube with insertion.way = \"funnel\"."},
        {{"tester"}, "Attrition tester: a drum (axis y, centre in the origin) with one baffle, after ASTM D4058."},
        {{"walls", "*"},
         "A wall of that name beside those of the rig, exact in closed form: a cone on a tube's floor, a lifter in a drum. Its contact row is "
         "`pellet-<name>`, else `pellet-<material>`. The loose cloud of a tube starts above these walls (planes that stand upright aside); elsewhere no pellet "
         "may overlap them at the start, nor be shut in a box, cylinder or cone unless that is meant."},
        {{"insertion"}, "How pellets come into the rig."},
        {{"time"}, "Time step and phases of the run."},
        {{"output"}, "What a run writes."},
        {{"measurement"}, "Grids of the measurement operators."},
    };
}

}  // namespace

const std::vector<CaseKey>& case_keys() {
    static const std::vector<CaseKey> keys = make_keys();
    return keys;
}

const std::vector<CaseSection>& case_sections() {
    static const std::vector<CaseSection> sections = make_sections();
    return sections;
}

std::vector<const CaseKey*> keys_of(const CaseSection& section) {
    std::vector<const CaseKey*> keys;
    for (const CaseKey& k : case_keys())
        if (k.path.size() == section.path.size() + 1 && std::equal(section.path.begin(), section.path.end(), k.path.begin())) keys.push_back(&k);
    return keys;
}

std::string path_text(const std::vector<std::string>& path) {
    std::string text;
    for (const std::string& segment : path) text += (text.empty() ? "" : ".") + (segment == "*" ? "<name>" : segment);
    return text;
}

bool is_idle_section(const CaseSection& section, Rig rig) {
    if (section.path.empty()) return false;
    if (section.path[0] == "funnel") return rig != Rig::pile;  // of a tube only with insertion.way = "funnel": not in a file to start from
    return section.path[0] != rig_name(rig) && std::any_of(all_rigs.begin(), all_rigs.end(), [&](Rig r) { return section.path[0] == rig_name(r); });
}

std::vector<std::string> names_in(const Case& c, const CaseSection& section) {
    std::vector<std::string> names;
    if (section.path.size() < 2) return {""};
    if (section.path[0] == "materials")
        for (const auto& [name, ignored] : c.materials) names.push_back(name);
    else if (section.path[0] == "walls")
        for (const auto& [name, ignored] : c.walls) names.push_back(name);
    else
        for (const auto& [name, ignored] : c.contacts) names.push_back(name);
    return names;
}

const Material* default_material(const std::string& name) {
    static const Material pellet{1800.0, 2e6, 0.25};
    static const Material vessel{1000.0, 3e9, 0.25};
    return name == "pellet" ? &pellet : name == "vessel" ? &vessel : nullptr;
}

const ContactParameters* default_contact(const std::string& name) {
    static const ContactParameters pellet_pellet{0.4, 0.7, 0.07};
    static const ContactParameters pellet_vessel{0.4, 0.7, 0.05};
    return name == "pellet-pellet" ? &pellet_pellet : name == "pellet-vessel" ? &pellet_vessel : nullptr;
}

const std::string& wall_material(const Case& c) {
    switch (c.rig) {
        case Rig::drum:
            return c.drum.material;
        case Rig::pile:
            return c.pile.material;
        case Rig::tester:
            return c.tester.material;
        case Rig::tube:
            break;
    }
    return c.tube.material;
}

}  // namespace pelletlab::io::detail

namespace pelletlab::io {

Case default_case(Rig rig) {
    Case c;
    c.rig = rig;
    c.name = rig_name(rig);
    if (rig == Rig::drum) c.pellet.count = 0;
    if (rig == Rig::pile) c.pellet.count = 7818;
    if (rig == Rig::tester) c.pellet.count = 3000;
    for (const char* name : {"pellet", "vessel"}) c.materials[name] = *detail::default_material(name);
    for (const char* name : {"pellet-pellet", "pellet-vessel"}) c.contacts[name] = *detail::default_contact(name);
    return c;
}

}  // namespace pelletlab::io
