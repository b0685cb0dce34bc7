// A case: everything that decides the outcome of a run, resolved to SI numbers. io/case_keys.cpp holds the one table that
// reads it from TOML, knows the defaults and documents every key; the values below are the same defaults.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab {

enum class Rig { tube, drum };

inline std::string rig_name(Rig rig) {
    return rig == Rig::drum ? "drum" : "tube";
}

/// Names of a rig's walls: a contact row «pellet-<wall name>» goes before «pellet-<material of the wall>».
inline std::vector<std::string> wall_names(Rig rig) {
    return rig == Rig::drum ? std::vector<std::string>{"shell", "front", "back"} : std::vector<std::string>{"shell", "floor"};
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
    Vec3 attraction = Vec3::Zero();           ///< [m/s²], a uniform field beside gravity
    double vibration_frequency = 0.0;         ///< [Hz], of all walls; 0: none
    Vec3 vibration_amplitude = Vec3::Zero();  ///< [m]
    bool energy_book = false;
    bool operator==(const PhysicsChoice&) const = default;
};

struct PelletChoice {
    std::string clump_file = "pellet.clump.toml";
    std::uint32_t count = 1000;  ///< 0: from the fill fraction of the rig
    std::string material = "pellet";
    bool operator==(const PelletChoice&) const = default;
};

/// Vertical tube: axis z, floor at z = 0.
struct TubeRig {
    double diameter = 0.052;    ///< [m], inner
    double height = 0.0;        ///< [m]; 0: high enough for the insertion
    std::uint32_t facets = 96;  ///< of the shell
    std::string mesh_file;      ///< a user's own shell and floor instead of the maker's
    std::string mesh_unit;
    std::string material = "vessel";
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
    bool operator==(const DrumRig&) const = default;
};

struct Insertion {
    double packing_fraction = 0.20;  ///< of the loose cloud of pellets before they fall
    double fall_speed = 0.0;         ///< [m/s], downward speed at release
    bool operator==(const Insertion&) const = default;
};

struct TimeControl {
    double step = 1e-5;                 ///< [s]
    double settle_limit = 2.0;          ///< [s], a bed not at rest by then gets the status «not at rest»
    double rest_kinetic_energy = 1e-6;  ///< bed counts as at rest when kinetic energy per pellet < this · m g d
    double spin_up = 1.0;               ///< [s] of rotation before measuring (drum)
    double measure = 1.0;               ///< [s] of rotation measured (drum)
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

struct Measurement {
    double height_grid = 0.001;    ///< [m], cell of the top-surface grid (tube)
    double velocity_grid = 0.002;  ///< [m], cell of the velocity map (drum)
    bool operator==(const Measurement&) const = default;
};

struct Case {
    std::string name = "tube";
    Rig rig = Rig::tube;
    std::uint64_t seed = 1;
    Vec3 gravity = {0.0, 0.0, -9.81};  ///< [m/s²]
    PelletChoice pellet;
    std::map<std::string, Material> materials;          ///< by name
    std::map<std::string, ContactParameters> contacts;  ///< by «pellet-pellet», «pellet-vessel», «pellet-<wall name>»
    PhysicsChoice physics;
    TubeRig tube;
    DrumRig drum;
    Insertion insertion;
    TimeControl time;
    Output output;
    Measurement measurement;
    std::string folder;  ///< of the case file; relative paths in it start here
    bool operator==(const Case&) const = default;
};

}  // namespace pelletlab
