// Contacts between bodies and one wall: cached nearby faces, cached sphere–face candidates, contact history, forces. Everything happens in the
// wall's own frame, so a moving rigid wall needs no new search tree and its motion enters through relative pose and velocity only.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "solver/detail/exact_surface_hits.hpp"
#include "solver/detail/pair_contacts.hpp"
#include "solver/detail/wall_mesh.hpp"
#include "solver/detail/wall_query.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::solver::detail {

/// History of one contact, keyed by sphere and patch; the frame is the wall's.
struct WallHistory {
    std::uint32_t sphere = 0, patch = 0;
    Vec3 normal = Vec3::UnitZ();  ///< from the wall to the body, of the last step
    Vec3 spring = Vec3::Zero();   ///< [m]
    Vec3 torque = Vec3::Zero();   ///< [N m], of the rolling spring
    double last_overlap = 0.0;    ///< [m], or −1 once a cohesive contact has come apart
};

struct WallCandidate {
    std::uint32_t sphere = 0, face = 0;
};

/// What a body near the wall keeps.
struct NearWall {
    std::vector<std::uint32_t> faces;       ///< near the body's bounding sphere
    std::vector<WallCandidate> candidates;  ///< sorted by (sphere, face)
    std::vector<WallHistory> history;       ///< sorted by (sphere, depth)
    RelativePose reference{{0, 0, 0}, {1, 0, 0, 0}};
    double allowance = -1.0;  ///< [m], as in pair_list.hpp
    double skin = 0.0;        ///< [m], of the candidates, adapted to how long they last
    std::uint32_t refreshed = 0;
};

/// Where a body is against a wall.
struct WallWatch {
    double place[3] = {0, 0, 0};  ///< of the centre of mass when the faces were looked up, frame of the wall
    double allowance = -1.0;      ///< [m] that it may move before they are looked up again
    /// The allowance is not used up while the paths of body and wall (Bodies::path, Wall::path) add up to no more than this [m].
    double settled_until = -std::numeric_limits<double>::infinity();
    std::unique_ptr<NearWall> near;  ///< only where faces are near
};

inline constexpr double always_awake = -std::numeric_limits<double>::infinity();  ///< of Wall::wake

struct Wall {
    Wall(const WallDefinition& definition, const LawRow& row, ContactKernel kernel, std::size_t spring_rows);

    bool is_exact() const { return exact.kind != ExactSurface::Kind::none; }
    std::uint32_t patch_of(const Hit& hit) const { return is_exact() ? hit.face : mesh.patch[hit.face]; }

    std::string name;
    WallMesh mesh;
    WallQuery query;
    LawRow law;
    ContactKernel contact;
    std::size_t spring_rows;
    ExactSurface exact;  ///< instead of the mesh unless its kind is `none`
    WallMotion motion;
    WallPlace place;                 ///< what the motion has come to
    std::uint64_t motion_start = 0;  ///< step at which `motion` began
    Pose start_pose, pose;
    Kinematic record;  ///< pose and velocity as contacts see them
    /// How far the wall may have gone in all [m], anywhere in the domain: bodies that have gone far themselves and bodies that it has passed must look again.
    double path = 0.0;
    /// Per body: one that is far from the wall needs no look while its own path (Bodies::path) and the wall's add up to no more than this [m].
    LargeVector<double> wake;
    LargeVector<WallWatch> watches;  ///< one a body
    LargeVector<LoadRow> loads;      ///< on each body, world, about its centre of mass; valid where touching
    std::vector<std::uint8_t> touching;
    std::vector<LoadRow> books;       ///< per block of bodies, where the law books; see BookColumn
    std::vector<LoadRow> body_books;  ///< per body, valid where touching; empty: nobody wants it
};

/// Places the wall where its motion has it after `step` steps of dt.
void move_wall(Wall& wall, std::uint64_t step, double dt);

/// How far lookups reach beyond what is needed now.
struct WallSkins {
    double faces = 0.0;       ///< [m]
    double candidates = 0.0;  ///< [m]
};

/// Forces of the wall on bodies [begin, end), the bodies of block `block`.
void wall_contact_forces(Wall& wall, std::size_t block, std::size_t begin, std::size_t end, const LargeVector<Kinematic>& kinematics, const Bodies& bodies,
                         const std::vector<BodyTemplate>& templates, const WallSkins& skins, const StepClock& clock);

/// One contact of a body with a wall, frame of the wall.
struct WallOverlap {
    std::uint32_t sphere = 0, patch = 0;
    Vec3 normal = Vec3::UnitZ();  ///< from the wall to the body
    double overlap = 0.0;         ///< [m]
};

/// Contacts of one body, found without any cached list: for checks and reports. Appends to `overlaps`.
void wall_overlaps(const Wall& wall, const Kinematic& body, const BodyTemplate& t, std::vector<WallOverlap>& overlaps);

}  // namespace pelletlab::solver::detail
