// What the number-crunching kernels read and write: plain data, no Eigen, so that a kernel file can be compiled for a newer instruction set
// without leaking its instructions into inline functions that other files share.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/physics.hpp"

namespace pelletlab::solver::detail {

/// A sphere of a template, body frame [m].
struct alignas(32) Ball {
    double x, y, z, r;
};

/// The spheres of a template once more as columns, body frame [m]; each column is filled up to a multiple of `widest` with spheres of radius −1e100, which no
/// search finds.
struct BallColumns {
    const double *x, *y, *z, *r;
    std::size_t count;
    double bounding_radius;
};

/// One body (or wall) as contacts see it, at the instant at which forces are computed. Two rows of one cache line each: place, then motion.
struct alignas(64) Kinematic {
    double place[8];   ///< position [m] (0–2), orientation w, x, y, z (3–6), largest distance of a sphere's centre from the centre of mass [m] (7)
    double motion[8];  ///< velocity [m/s] (0–2), spin [rad/s] (3–5), 1/mass [1/kg] (6), 1/smallest moment of inertia [1/(kg m²)] (7); 0 for a wall

    double* position() { return place; }
    const double* position() const { return place; }
    double* turn() { return place + 3; }
    const double* turn() const { return place + 3; }
    double* velocity() { return motion; }
    const double* velocity() const { return motion; }
    double* spin() { return motion + 3; }
    const double* spin() const { return motion + 3; }
};

/// A pair of bodies with its cached candidates; see pair_list.hpp.
struct alignas(64) PairRecord {
    /// Of j in the frame of i when the candidates were found: place [m] (0–2), turn w, x, y, z (3–6); and how much relative motion [m] they
    /// stand (7), negative when they were not found yet.
    float reference[8];
    std::uint32_t i, j;
    std::uint32_t first;  ///< candidate in the pool of its block
    std::uint16_t count, capacity;
    std::uint16_t template_i, template_j;
    float skin;               ///< [m], of the candidate list, adapted to how long lists last
    std::uint32_t refreshed;  ///< step (modulo 2³²) at which the candidates were found
};

/// Sphere a of body i and sphere b of body j; the top bit of a says that they touched in the last step and have a spring.
struct Candidate {
    static constexpr std::uint16_t touching_bit = 0x8000;
    std::uint16_t a, b;
    std::uint16_t sphere_a() const { return static_cast<std::uint16_t>(a & ~touching_bit); }
    bool touching() const { return (a & touching_bit) != 0; }
    std::uint32_t key() const { return (static_cast<std::uint32_t>(sphere_a()) << 16) | b; }
};

/// What a contact remembers, in the frame of body i: the tangential displacement [m] (0–2) and the overlap of the last step [m], or −1 once a
/// cohesive contact has come apart (3).
/// With elastic–plastic rolling a second row follows: the rolling spring's torque [N m] (0–2).
struct alignas(32) Spring {
    double row[4];
};

/// Force [N] (0–2) and torque [N m] (3–5) in one cache line.
struct alignas(64) LoadRow {
    double row[8];

    double* force() { return row; }
    const double* force() const { return row; }
    double* torque() { return row + 3; }
    const double* torque() const { return row + 3; }
};

/// Constants of one pair of materials; see contact_law_impl.hpp, rolling_law_impl.hpp and cohesion_impl.hpp for the formulas.
struct LawRow {
    double normal_stiffness = 0.0;    ///< 2 E* [Pa]; of the linear law k_n [N/m]
    double tangential_ratio = 0.0;    ///< S_t / S_n = 4 G*/E*
    double damping = 0.0;             ///< ≥ 0, of the normal direction: the law's own number, see materials.cpp
    double tangential_damping = 0.0;  ///< the same for the tangential direction
    double sliding_friction = 0.0;    ///< μ; the static one where friction falls with speed
    double rolling_friction = 0.0;
    bool wall = false;  ///< the first one is a wall: R* = r_j, and the contact point lies on the wall

    // What only laws with extras look at.
    double friction_drop = 0.0;      ///< μ_static − μ_kinetic
    double friction_speed = 1.0;     ///< v_c [m/s]
    double rolling_stiffness = 0.0;  ///< 2.25 μ_r²
    double rolling_damping = 0.0;    ///< 2 η_r
    double rolling_damping_full = 0.0;
    Cohesion cohesion = Cohesion::none;
    double cohesion_strength = 0.0;  ///< force [N], 2π × energy density [Pa], 4 π w / (2 E*) [m], or 4 π γ cos θ [N/m]: by the kind of cohesion
    double half_modulus = 0.0;       ///< E* [Pa] of JKR
    double bridge_volume = 0.0;      ///< [m³]
    double reach = 0.0;              ///< [m], the gap beyond which no contact of these materials holds together
    bool shared = false;             ///< ClumpPolicy::shared
    bool booked = false;             ///< fill ContactBatch::book

    bool plain() const { return cohesion == Cohesion::none && friction_drop == 0.0 && !shared && !booked; }
};

/// What every contact of a step shares.
struct StepClock {
    double spring_step = 0.0;  ///< [s], over which tangential springs grow; 0 when forces are only looked at
    double step = 0.0;         ///< [s]
    std::uint32_t index = 0;   ///< step count (modulo 2³²)
};

/// Motion of a touching pair (i, j) in the frame of i; i may be a wall.
struct alignas(64) PairSlot {
    /// v_j − v_i − ω_j × p with p the place of j [m/s] (0–2), ω_j − ω_i [rad/s] (3–5): the velocity of j against i at x is the first plus the second × x.
    /// Then 1 / (1/m_i + 1/m_j) [kg] (6) and the share of the reduced inertia that rolling friction of one contact may stop in one step [kg m²] (7).
    double row[8];
};

/// Touching spheres of many pairs, structure of arrays; every array has room for a full register behind the last contact.
struct ContactBatch {
    std::size_t size = 0;
    double *dx, *dy, *dz;   ///< [m], from the centre of sphere a (or the nearest point of the wall) to the centre of sphere b
    double *ax, *ay, *az;   ///< [m], the centre of sphere a (or the point of the wall), frame of i
    double *ra, *rb;        ///< [m], radii; ra = 0 for a wall
    std::uint32_t* slot;    ///< pair
    std::uint32_t* spring;  ///< tangential displacement: index into `springs`, different for every contact
    Spring* springs;        ///< in and out; as many rows a contact as the law remembers
    double* share;          ///< of the load of its pair that a contact carries; filled where the law says so
    LoadRow* book;          ///< out, where the law says so: see BookColumn
    LoadRow* result;        ///< out: force on j, torque on j about the origin of frame i; row[6] is the normal force
};

/// Columns of ContactBatch::book [J]. Stored energy at this instant, then what went in this step.
enum BookColumn : std::size_t {
    book_elastic_normal,
    book_elastic_tangential,
    book_elastic_rolling,
    book_normal_damping,
    book_tangential_damping,
    book_sliding,
    book_rolling,
    book_fed,  ///< put in by forces without a potential: cohesion, springs whose stiffness changes while they are loaded
};

inline constexpr std::size_t widest = 8;  ///< lanes of the widest register

/// Rolling friction of one contact may stop at most this share of a body's spin in a step (a body has rarely more than eight neighbours).
inline constexpr double rolling_share = 1.0 / 8.0;

/// Pose of j in the frame of i: place (0–2), rotation matrix by rows (3–11).
struct alignas(64) PairPose {
    double row[16];
};

/// Scratch of one worker for one block of pairs; every array has room for a full register behind the last pair.
struct PairScratch {
    PairPose* poses;
    std::uint8_t* stale;
    std::uint16_t* counts;  ///< of candidates
    std::uint32_t listed_count, active_count;
    std::uint32_t* listed;         ///< pairs with candidates, counted from the block's first
    std::uint32_t* active;         ///< touching pairs, counted likewise; room for all pairs
    std::uint32_t* first_contact;  ///< of each touching pair; one more at the end
    PairSlot* slots;
    LoadRow *sums, *loads_i;
};

/// One block of pairs as the force kernel sees it: all pairs whose first body is in [body_begin, body_end).
struct PairBlockView {
    const PairRecord* records;
    std::size_t count;
    std::size_t body_begin, body_end;
    const Kinematic* kinematics;
    const Ball* const* balls;  ///< per template
    Candidate* candidates;
    Spring* springs;
    std::size_t spring_rows;     ///< per candidate
    LoadRow* book;               ///< out: sum over the contacts of the block, where the law books
    LoadRow* pair_books;         ///< out, per touching pair: the same sum over its contacts; null: nobody wants it
    LoadRow* loads_j;            ///< out, per pair: what the second body feels, world, about its centre; only where touching
    std::uint8_t* touching;      ///< out, per pair
    LoadRow* own_loads;          ///< out, per body: what it feels from the pairs in which it is the first; only where own_touching
    std::uint8_t* own_touching;  ///< out, per body
};

/// What motion needs of a template; see motion.hpp.
struct alignas(64) MotionConstants {
    /// 1/mass, mass, 1/principal moments (2–4), 1/I of the transverse axes (5), 1/I_axis − 1/I_transverse (6), the same for the second axis (7),
    /// axis (8–10), second axis (11–13), largest distance of a sphere's centre (14), 1/smallest moment (15).
    double row[16];
};

/// The bodies as structure of arrays; padded to a multiple of `widest`.
struct BodyArrays {
    std::size_t count;  ///< without the padding
    double *position[3], *turn[4], *velocity[3], *momentum[3], *force[3], *torque[3];
    const double* reference[3];  ///< positions at the last neighbour search
    double* path;                ///< how far they have gone in all [m]
    const std::uint32_t* template_index;
    const MotionConstants* constants;
    Kinematic* records;
};

struct DriftSettings {
    double step;             ///< [s]
    double low[3], high[3];  ///< domain [m]
};

struct DriftResult {
    std::size_t first_lost;  ///< the first body outside the domain or not a number; the end if there is none
    double furthest2;        ///< [m²], largest squared distance from the reference positions
};

/// A pair and the body that comes second in it.
struct Incoming {
    std::uint32_t pair, body;
};

/// All loads that bodies collect.
struct GatherView {
    const std::uint32_t* incoming_first;  ///< per body: where its row of `incoming` begins; one more at the end
    const Incoming* incoming;             ///< sorted by body, then by the id of the first body
    const LoadRow *loads_j, *own_loads;
    const std::uint8_t *touching, *own_touching;
    std::size_t wall_count;
    const LoadRow* const* wall_loads;
    const std::uint8_t* const* wall_touching;
    double gravity[3];
};

/// A search for the sphere pairs of two bodies that may touch soon.
struct CandidateSearch {
    double place[3], turn[9];  ///< of the second body in the frame of the first [m]; rotation matrix by rows
    double extent;             ///< [m], as large as any number here, for the rounding of bounds
    double skin, reach;        ///< [m], gaps that are listed and gaps that are looked at
    // Scratch, of as many spheres as the second body has and two full registers more.
    double *x, *y, *z, *r;
    std::uint16_t* index;
    std::size_t facing;
    Candidate* found;  ///< out, sorted by (a, b)
    std::size_t capacity, count;
    double nearest_other;  ///< [m], out: sphere pairs that are not listed are at least that far apart, or `reach`, or more where nothing comes that near
};

/// Forces of all contacts of a batch; `slots` are those of the pairs.
using ContactKernel = void (*)(const LawRow& law, ContactBatch& batch, const PairSlot* slots, const StepClock& clock);

inline constexpr std::size_t contact_model_count = 4, rolling_model_count = 3;

struct Kernels {
    const char* name;
    void (*drift)(const BodyArrays& bodies, std::size_t begin, std::size_t end, const DriftSettings& settings, DriftResult& result);
    void (*gather)(const BodyArrays& bodies, const GatherView& loads, std::size_t begin, std::size_t end, double kick);
    /// False when there is no room for all that may be found.
    bool (*search)(const BallColumns& first, const BallColumns& second, CandidateSearch& search);
    /// Relative poses of the block's pairs, and which candidate lists are stale.
    void (*find_poses)(const PairBlockView& block, PairScratch& scratch);
    /// Touching spheres, contact forces, history and loads of the block; poses must be there. The batch must have room for all candidates.
    void (*pair_forces)(ContactKernel contact, const LawRow& law, const PairBlockView& block, PairScratch& scratch, ContactBatch& batch,
                        const StepClock& clock);
    /// The same for contacts that hold together beyond touching.
    void (*sticky_pair_forces)(ContactKernel contact, const LawRow& law, const PairBlockView& block, PairScratch& scratch, ContactBatch& batch,
                               const StepClock& clock);
    /// By contact model and rolling model, each compiled by itself: without and with extras (see LawRow).
    ContactKernel plain[contact_model_count][rolling_model_count], rich[contact_model_count][rolling_model_count];
};

const Kernels& scalar_kernels();

/// The kernel that suits a law.
inline ContactKernel contact_kernel(const Kernels& kernels, const Physics& physics, const LawRow& law) {
    const auto model = static_cast<std::size_t>(physics.contact), rolling = static_cast<std::size_t>(physics.rolling);
    return law.plain() ? kernels.plain[model][rolling] : kernels.rich[model][rolling];
}

/// Rows of history a contact.
inline std::size_t spring_rows(const Physics& physics) {
    return physics.rolling == RollingModel::elastic_plastic ? 2 : 1;
}

/// Null where the processor or the build lacks the instructions.
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();
/// The fastest set that this processor runs; all sets give the same bits.
const Kernels& best_kernels();

}  // namespace pelletlab::solver::detail
