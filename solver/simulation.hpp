// The DEM engine: bodies made of spheres, triangle-mesh walls, contact laws, time steps. It knows spheres, bodies and walls and
// never sees how a clump was made or what a rig is.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"
#include "core/vec.hpp"
#include "solver/body_forces.hpp"
#include "solver/contact_events.hpp"
#include "solver/energy_book.hpp"
#include "solver/exact_surface.hpp"
#include "solver/physics.hpp"
#include "solver/wall_motion.hpp"
#include "solver/wall_report.hpp"

namespace pelletlab::solver {

struct ElasticMaterial {
    double shear_modulus = 2e6;  ///< [Pa]
    double poisson_ratio = 0.25;
};

/// Contact parameters of pellet–pellet or pellet–one wall.
struct PairParameters {
    double restitution = 0.4;
    double sliding_friction = 0.7;
    double rolling_friction = 0.05;
    // Of laws that ask for them; see solver/physics.hpp.
    double kinetic_friction_ratio = 1.0;  ///< μ_k / μ_s: μ(v) = μ_k + (μ_s − μ_k) / (1 + |v_t| / v_c), v_c = Physics::friction_decay_speed; 1: constant
    double relaxation_time = 0.0;         ///< [s], A of ContactModel::viscoelastic
    double attraction_force = 0.0;        ///< [N], of Cohesion::constant_force
    double cohesion_energy_density = 0.0;  ///< [J/m³], of Cohesion::sjkr
    double work_of_adhesion = 0.0;         ///< [J/m²], of Cohesion::jkr: twice the surface energy of equal materials
};

struct WallDefinition {
    std::string name;
    TriangleMesh mesh;   ///< world frame at time 0; normals play no role, both sides act
    ExactSurface exact;  ///< takes the mesh's place in contacts unless its kind is `none`; the mesh may then be empty
    ElasticMaterial material;
    PairParameters contact;  ///< with the pellets
    WallMotion motion;
    double feature_angle = 0.5235987755982988;  ///< [rad], joins flatter than this (30°) belong to one smooth patch
};

/// How far the neighbour search looks ahead [m]; 0 chooses it from the size of the bodies. Results do not depend on it, speed does.
struct SearchSkins {
    double bodies = 0.0;           ///< between bounding spheres
    double spheres = 0.0;          ///< between the spheres of two bodies
    double wall_faces = 0.0;       ///< between bounding spheres and wall faces
    double wall_candidates = 0.0;  ///< between spheres and wall faces
};

/// Instructions of the inner loops. All give the same bits; `fastest` takes the best that the processor has.
enum class InstructionSet { fastest, scalar, avx2, avx512 };

struct SimulationDefinition {
    std::vector<RigidTemplate> templates;
    ElasticMaterial pellet_material;
    PairParameters pellet_contact;
    std::vector<WallDefinition> walls;
    Vec3 gravity = {0.0, 0.0, -9.81};  ///< [m/s²]
    double time_step = 1e-5;           ///< [s]
    Box domain;                        ///< a body whose centre leaves it is an Error(numerical) with place, time and cause; empty: the walls' box, enlarged
    SearchSkins skins;
    InstructionSet instructions = InstructionSet::fastest;
    Physics physics;
    BodyForces body_forces;
};

struct BodyPlacement {
    std::uint32_t template_index = 0;
    Pose pose;
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    Vec3 spin = Vec3::Zero();      ///< [rad/s], world
};

/// Structure of arrays, one entry a body, in the order in which bodies were added.
struct BodyState {
    std::vector<std::uint32_t> template_index;
    std::vector<Vec3> position;     ///< [m], world
    std::vector<Quat> orientation;  ///< body → world
    std::vector<Vec3> velocity;     ///< [m/s], world, same instant as position
    std::vector<Vec3> spin;         ///< [rad/s], world, same instant
    std::vector<Vec3> force;        ///< [N], world, contact and gravity
    std::vector<Vec3> torque;       ///< [N m], world, about the centre of mass
    std::size_t size() const { return position.size(); }
};

struct WallLoad {
    Vec3 force = Vec3::Zero();   ///< [N], on the wall
    Vec3 torque = Vec3::Zero();  ///< [N m], on the wall, about motion.point, shifted with the wall
    double power = 0.0;          ///< [W], that the wall's motion gives to the bodies: −(force · velocity of that point + torque · spin)
};

struct ContactSummary {
    std::size_t sphere_contacts = 0;  ///< touching sphere pairs
    std::size_t wall_contacts = 0;
    std::size_t touching_pairs = 0;      ///< touching body pairs
    double largest_overlap_ratio = 0.0;  ///< overlap / radius of the smaller sphere
};

/// One touching sphere pair, or a sphere touching a wall.
struct ContactPoint {
    std::uint32_t body_i = 0, sphere_i = 0;  ///< the first body; with a wall: the body
    std::int32_t wall = -1;                  ///< index of the wall, or −1
    std::uint32_t body_j = 0, sphere_j = 0;  ///< the second body; unused with a wall
    Vec3 normal = Vec3::UnitZ();             ///< from i to j; with a wall: from the wall to the body
    double overlap = 0.0;                    ///< [m]
    Vec3 spring = Vec3::Zero();              ///< [m], tangential displacement, world
};

/// What the neighbour search holds at present: for tuning and reports.
struct SearchReport {
    std::size_t listed_pairs = 0;  ///< body pairs
    std::size_t pairs_with_candidates = 0;
    std::size_t candidates = 0;         ///< sphere pairs
    std::size_t bodies_near_walls = 0;  ///< counted once a wall
    std::size_t wall_candidates = 0;    ///< sphere–face pairs
    std::size_t bytes = 0;              ///< memory of bodies, pairs and walls' lists
};

/// Wall-clock time that a stage of the step has taken since the simulation was made: for reports of where the time goes, not part of any result.
struct StageTime {
    std::string name;
    double seconds = 0.0;
};

class Simulation {
public:
    /// Throws Error(bad_input) for a definition that cannot be run.
    explicit Simulation(SimulationDefinition definition);
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    /// Throws Error(bad_input) when bodies overlap each other or a wall by more than `overlap_allowed` of their smallest sphere's radius. More than the
    /// usual 5 % is for settled beds that come from elsewhere.
    void add_bodies(std::span<const BodyPlacement> bodies, double overlap_allowed = 0.05);

    /// One time step: see solver/step.cpp, a list of named stages.
    void step();
    void advance(std::uint64_t steps);

    /// The motion begins now, where the wall is. Throws Error(bad_input) for one that jumps: further in a step than the smallest sphere's radius.
    void set_wall_motion(std::size_t wall, const WallMotion& motion);

    double time() const;
    std::uint64_t step_count() const;
    const SimulationDefinition& definition() const;
    const BodyState& bodies() const;
    std::vector<Pose> wall_poses() const;
    const std::vector<WallLoad>& wall_loads() const;
    ContactSummary contacts() const;
    /// Every contact at the present instant, ordered by bodies and spheres, those with walls last.
    std::vector<ContactPoint> contact_points() const;
    std::vector<WallReport> wall_reports() const;
    std::uint64_t neighbour_rebuilds() const;
    SearchReport search_report() const;
    std::vector<StageTime> stage_times() const;
    EnergyReport energy() const;

    /// From the next step on contacts are followed from first to last touch (solver/contact_events.hpp); what was recorded before is forgotten. Costs some speed
    /// and changes no bit of the motion. Throws Error(bad_input) without Physics::energy_book, from which the energies come.
    void record_contact_events();
    /// Pellet–pellet, then one entry a wall; empty when nothing is recorded.
    std::vector<ContactEvents> contact_events() const;

    /// Hash over every bit that decides the future: poses, velocities, contact history, wall poses.
    std::uint64_t state_hash() const;

    /// Everything that decides the future, with a checksum: a restored simulation of the same definition goes on bit for bit.
    std::string checkpoint() const;
    /// Throws Error(bad_input), and changes nothing, for bytes that are damaged or of another definition; `name` says in the message where they come from.
    void restore(std::string_view bytes, const std::string& name);

    /// The same in a file, written to a temporary name, brought to the disk and renamed.
    void save_checkpoint(const std::filesystem::path& file) const;
    void load_checkpoint(const std::filesystem::path& file);

    struct State;  ///< private to this room: solver/detail/state.hpp

private:
    std::unique_ptr<State> state_;
};

}  // namespace pelletlab::solver
