// Body pairs with their cached candidate sphere pairs and contact history.
//
// A pair remembers the relative pose at which its candidates were found, and an allowance: sphere pairs that are not listed were at least that far apart,
// so the list holds until |Δp| + 2 ρ |Δq| (in the frame of i; p, q the pose of j in it, ρ the largest offset of a sphere of j) exceeds it.
// The result of a step depends on neither list: candidates are a superset of the contacts, in a fixed order.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "solver/detail/bodies.hpp"
#include "solver/detail/broad_phase.hpp"

namespace pelletlab::solver::detail {

/// Sphere a of body i and sphere b of body j; the top bit of a says that they touched in the last step and have a spring.
struct Candidate {
    static constexpr std::uint16_t touching_bit = 0x8000;
    std::uint16_t a, b;
    std::uint16_t sphere_a() const { return static_cast<std::uint16_t>(a & ~touching_bit); }
    bool touching() const { return (a & touching_bit) != 0; }
    std::uint32_t key() const { return (static_cast<std::uint32_t>(sphere_a()) << 16) | b; }
};

/// Tangential displacement [m] in the frame of body i.
struct Spring {
    double x = 0.0, y = 0.0, z = 0.0;
};

struct PairRecord {
    std::uint32_t i = 0, j = 0;
    std::uint32_t first = 0;  ///< candidate in the pool of its block
    std::uint16_t count = 0, capacity = 0;
    float place[3] = {0, 0, 0};  ///< of j in the frame of i when the candidates were found
    float turn[4] = {1, 0, 0, 0};
    float allowance = -1.0f;  ///< [m]; negative: candidates not found yet
};

/// What pair k exerts, world frame. Only valid where touching[k] is set.
struct PairLoad {
    double force[3];     ///< [N], on j; −force acts on i
    double torque_i[3];  ///< [N m]
    double torque_j[3];
};

/// Pairs that are worked on together; their candidates lie together.
struct PairBlock {
    static constexpr std::size_t pairs_per_block = 128;
    std::vector<Candidate> candidates;
    std::vector<Spring> springs;
};

struct PairList {
    NeighbourRows rows;
    std::vector<PairRecord> records;  ///< sorted by (i, j)
    std::vector<PairBlock> blocks;    ///< block k holds records [k·128, (k+1)·128)
    std::vector<PairLoad> loads;
    std::vector<std::uint8_t> touching;
    std::vector<std::uint32_t> incoming_first, incoming;  ///< for body j: the records in which it is the second one
    std::vector<Vec3> reference;                          ///< positions at the last rebuild
    double skin = 0.0;                                    ///< [m], of the body list
    double pair_skin = 0.0;                               ///< [m], of candidate lists
    std::uint64_t rebuilds = 0;
};

/// Makes the list anew; candidates and history of pairs that stay are carried over.
void rebuild_pairs(PairList& list, const Bodies& bodies, const std::vector<BodyTemplate>& templates);

/// Pose of j in the frame of i.
struct RelativePose {
    double p[3];
    double q[4];
};

RelativePose relative_pose(const Kinematic& i, const Kinematic& j);

/// Finds the candidates of record k anew for this relative pose; history is carried over by (sphere a, sphere b).
void refresh_candidates(PairBlock& block, PairRecord& record, const BodyTemplate& ti, const BodyTemplate& tj, const RelativePose& pose, double skin);

}  // namespace pelletlab::solver::detail
