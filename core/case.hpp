// A case: everything that decides the outcome of a run, resolved to SI numbers. io/case_keys.cpp holds the one table that
// reads it from TOML, knows the defaults and documents every key; the values below are the same defaults.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab {

enum class Rig { tube, drum, pile, tester };

inline constexpr std::array<Rig, 4> all_rigs{Rig::tube, Rig::drum, Rig::pile, Rig::tester};

inline std::string rig_name(Rig rig) {
    constexpr std::array<const char*, 4> names{"tube", "drum", "pile", "tester"};
    return names[static_cast<std::size_t>(rig)];
}

/// Elastic constants and density of one material.
struct Material {
    double density = 1000.0;     ///< [kg/m³]
    double shear_modulus = 2e6;  ///< [Pa]
    double poisson_ratio = 0.25;
    bool operator==(const Material&) const = default;
};

/// Contact parameters of one pair: pellet–pellet, or pellet–wall by the wall's name or its material.
struct ContactParameters {
    double restitution = 0.4;
    double sliding_friction = 0.7;
    double rolling_friction = 0.05;
    // Of laws that ask for them (PhysicsChoice); a row need not state these.
    double kinetic_friction_ratio = 1.0;   ///< kinetic / static friction; 1: friction does not depend on speed
    double relaxation_time = 0.0;          ///< [s], of contact_model «viscoelastic»
    double attraction_force = 0.0;         ///< [N], of cohesion «constant_force»
    double cohesion_energy_density = 0.0;  ///< [J/m³], of cohesion «sjkr»
    double work_of_adhesion = 0.0;         ///< [J/m²], of cohesion «jkr»
    bool operator==(const ContactParameters&) const = default;
};

/// The laws of a run; what each means stands in solver/physics.hpp and solver/body_forces.hpp.
struct PhysicsChoice {
    std::string contact_model = "hertz_edem";
    std::string rolling_model = "constant_torque";
    std::string cohesion = "none";
    std::string clump_contacts = "sum";
    double linear_stiffness = 1e4;  ///< [N/m]
    double rolling_damping = 0.3;
    double rolling_damping_sliding = 0.0;
    double friction_decay_speed = 0.1;        ///< [m/s]
    double liquid_surface_tension = 0.0728;   ///< [N/m]
    double liquid_contact_angle = 0.0;        ///< [rad]
    double liquid_bridge_volume = 1e-12;      ///< [m³]
    double air_density = 0.0;                 ///< [kg/m³]; 0: no drag
    double air_viscosity = 1.8e-5;            ///< [Pa s]
    Vec3 attraction = Vec3::Zero();           ///< [m/s²], a uniform field beside gravity
    double vibration_frequency = 0.0;         ///< [Hz], of all walls; 0: none
    Vec3 vibration_amplitude = Vec3::Zero();  ///< [m]
    bool energy_book = false;
    bool operator==(const PhysicsChoice&) const = default;
};

struct PelletChoice {
    std::string clump_file = "pellet.clump.toml";
    std::uint32_t count = 1000;  ///< 0: from the fill fraction of the rig
    double size_factor = 1.0;    ///< all lengths of the pellet / those of the clump file
    std::string material = "pellet";
    bool operator==(const PelletChoice&) const = default;
};

/// Vertical tube: axis z, floor at z = 0. A lying one: axis y, centre in the origin, end plates at y = ±height/2.
struct TubeRig {
    double diameter = 0.052;    ///< [m], inner
    double height = 0.0;        ///< [m]; 0: high enough for the insertion; of a lying tube its length
    bool lying = false;         ///< filled and measured with its axis level
    std::uint32_t facets = 96;  ///< of the shell
    std::string mesh_file;      ///< a user's own vessel instead of the maker's
    std::string mesh_unit;
    std::string material = "vessel";
    std::string surface = "facets";  ///< «exact»: shell and floor (end plates) in closed form; the facets are for pictures only
    bool operator==(const TubeRig&) const = default;
};

/// Horizontal drum: axis y, centre in the origin, end plates at y = ±length/2. A positive speed turns about +y:
/// seen along +y (the camera's view, x to the right, z up) clockwise, so the bed climbs on the left, at x < 0.
struct DrumRig {
    double diameter = 0.080;              ///< [m], inner
    double length = 0.020;                ///< [m]
    double speed = 2.0943951023931953;    ///< [rad/s], 20 rpm
    double fill_fraction = 0.20;          ///< bed's bulk volume / drum volume, used when pellet.count = 0
    double bulk_packing_fraction = 0.60;  ///< turns bulk volume into pellets
    std::uint32_t facets = 120;
    bool end_plates_rotate = true;
    std::string mesh_file;
    std::string mesh_unit;
    std::string material = "vessel";
    std::string surface = "facets";  ///< «exact»: shell and end plates in closed form; the facets are for pictures only
    bool operator==(const DrumRig&) const = default;
};

/// Funnel with a shutter, about the z axis: cylinder above, cone, round outlet. Of the pile (release «funnel») and of the tube (insertion.way «funnel»).
struct FunnelRig {
    double outlet_diameter = 0.030;          ///< [m]
    double top_diameter = 0.100;             ///< [m], of the cylinder above the cone
    double half_angle = 0.5235987755982988;  ///< [rad], between the cone's wall and the vertical: 30°
    double outlet_height = 0.0;              ///< [m] of the outlet above the plate or the tube's floor; 0: 100 mm, or just above the tube's rim
    double shutter_time = 0.05;              ///< [s] in which the shutter slides away
    std::uint32_t facets = 96;
    std::string mesh_file;  ///< a user's own funnel instead of the maker's
    std::string mesh_unit;
    bool operator==(const FunnelRig&) const = default;
};

/// A pile on a flat plate z = 0. What runs off the plate falls into a tray below it.
struct PileRig {
    std::string release = "funnel";    ///< «funnel»: see FunnelRig; «cylinder»: an open cylinder that stands on the plate is lifted
    double plate_diameter = 0.400;     ///< [m]
    double cylinder_diameter = 0.030;  ///< [m], inner
    double lift_speed = 0.020;         ///< [m/s]
    double discharge_limit = 4.0;      ///< [s] after the release began; a pile not at rest by then gets the status «not at rest»
    std::string mesh_file;             ///< a user's own cylinder
    std::string mesh_unit;
    std::string material = "vessel";
    bool operator==(const PileRig&) const = default;
};

/// Attrition tester (ASTM D4058): a drum as DrumRig, with one radial baffle over its length. The baffle's angle is 0 at the bottom and grows with the turn.
struct TesterRig {
    double diameter = 0.254;                       ///< [m], inner
    double length = 0.152;                         ///< [m]
    double baffle_height = 0.051;                  ///< [m], from the shell inward; 0: no baffle
    double baffle_thickness = 0.003;               ///< [m]
    double baffle_start = 3.14159265358979323846;  ///< [rad], angle while the pellets are filled in; at the top
    double speed = 4.1887902047863905;             ///< [rad/s], 40 rpm
    std::uint32_t facets = 120;
    std::string mesh_file;         ///< a user's own shell and end plates
    std::string baffle_mesh_file;  ///< a user's own baffle, at the angle baffle_start
    std::string mesh_unit;         ///< of both
    std::string material = "vessel";
    bool operator==(const TesterRig&) const = default;
};

/// A wall beside those of the rig, in closed form: [walls.<name>]. World frame; both sides act.
struct ExtraWall {
    std::string shape = "plane";  ///< plane, disc, cylinder, cone or box
    Vec3 point = Vec3::Zero();    ///< [m], of the plane; centre of disc and box; centre of the end at which cylinder and cone begin
    Vec3 axis = Vec3::UnitZ();    ///< normal of plane and disc, axis of cylinder and cone; of any length
    double radius = 0.0;          ///< [m], of disc and cylinder; of the cone at `point`
    double far_radius = 0.0;      ///< [m], of the cone at its other end
    double length = 0.0;          ///< [m], of cylinder and cone
    Vec3 size = Vec3::Zero();     ///< [m], full edges of the box, along the world's axes
    std::string material = "vessel";
    bool turns = false;  ///< with the drum or tester
    bool operator==(const ExtraWall&) const = default;
};

struct Insertion {
    std::string way = "cloud";       ///< of a tube: «cloud», «sieve», «batches», «funnel»
    double packing_fraction = 0.20;  ///< of the loose cloud of pellets before they fall
    double fall_speed = 0.0;         ///< [m/s], downward speed at release
    std::uint32_t batches = 4;       ///< of way «batches»: each comes to rest before the next falls
    double sieve_rate = 5000.0;      ///< [1/s], pellets that leave the sieve, of way «sieve»
    double sieve_height = 0.0;       ///< [m] of the sieve above the floor; 0: twice the height that the bed will have, and 50 mm
    std::uint32_t taps = 0;          ///< of the vessel once the bed is at rest
    double tap_amplitude = 0.001;    ///< [m], upward
    double tap_frequency = 20.0;     ///< [Hz], of the single swing of a tap
    bool operator==(const Insertion&) const = default;
};

struct TimeControl {
    double step = 1e-5;                 ///< [s]
    double settle_limit = 2.0;          ///< [s], a bed not at rest by then gets the status «not at rest»
    double rest_kinetic_energy = 1e-6;  ///< bed counts as at rest when kinetic energy per pellet < this · m g d …
    double rest_contact_change = 0.01;  ///< … and the number of touching pairs stays within this share of itself
    double spin_up = 1.0;               ///< [s] of rotation before measuring (drum, tester)
    double measure = 1.0;               ///< [s] of rotation measured (drum, tester)
    bool operator==(const TimeControl&) const = default;
};

struct Output {
    double frame_interval = 0.01;  ///< [s] between stored frames
    bool paraview = true;
    std::uint32_t paraview_every = 10;  ///< each n-th stored frame, and the last
    bool pictures = true;
    bool picture_spheres = false;        ///< draw the clump's spheres instead of the true surface
    std::uint32_t picture_width = 1200;  ///< [pixel]
    bool operator==(const Output&) const = default;
};

struct MeasurementGrids {
    double height_grid = 0.001;    ///< [m], cell of the top-surface grid (tube, pile)
    double velocity_grid = 0.002;  ///< [m], cell of the maps (drum, tester)
    bool operator==(const MeasurementGrids&) const = default;
};

struct Case {
    std::string name = "tube";
    Rig rig = Rig::tube;
    std::uint64_t seed = 1;
    Vec3 gravity = {0.0, 0.0, -9.81};  ///< [m/s²]
    PelletChoice pellet;
    std::map<std::string, Material> materials;          ///< by name
    std::map<std::string, ContactParameters> contacts;  ///< by «pellet-pellet», «pellet-vessel», «pellet-<wall name>»
    std::map<std::string, ExtraWall> walls;             ///< by name
    PhysicsChoice physics;
    TubeRig tube;
    DrumRig drum;
    PileRig pile;
    FunnelRig funnel;
    TesterRig tester;
    Insertion insertion;
    TimeControl time;
    Output output;
    MeasurementGrids measurement;
    std::string folder;  ///< of the case file; relative paths in it start here
    bool operator==(const Case&) const = default;
};

/// True for a case that pours through a funnel.
inline bool has_funnel(const Case& c) {
    return (c.rig == Rig::pile && c.pile.release == "funnel") || (c.rig == Rig::tube && !c.tube.lying && c.insertion.way == "funnel");
}

/// Names of the rig's own walls, beside which a case may have others (Case::walls): a contact row «pellet-<wall name>» goes before «pellet-<material of the
/// wall>».
inline std::vector<std::string> wall_names(const Case& c) {
    std::vector<std::string> names;
    switch (c.rig) {
        case Rig::tube:
            names = c.tube.lying ? std::vector<std::string>{"shell", "front", "back"} : std::vector<std::string>{"shell", "floor"};
            break;
        case Rig::drum:
            names = {"shell", "front", "back"};
            break;
        case Rig::pile:
            names = {"plate", "tray"};
            if (c.pile.release == "cylinder") names.emplace_back("cylinder");
            break;
        case Rig::tester:
            names = {"shell", "front", "back", "baffle"};
            break;
    }
    if (has_funnel(c)) names.insert(names.end(), {"funnel", "shutter"});
    return names;
}

}  // namespace pelletlab
