// Body pairs with their cached candidate sphere pairs and contact history.
//
// A pair remembers the relative pose at which its candidates were found, and an allowance: sphere pairs that are not listed were at least that far apart,
// so the list holds until |Δp| + 2 ρ |Δq| (in the frame of i; p, q the pose of j in it, ρ the largest offset of a sphere of j) exceeds it.
// The result of a step depends on neither list: candidates are a superset of the contacts, in a fixed order. So the skin of each pair may follow
// how long its lists last: short lists where nothing moves, long-lived ones where much does.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "solver/detail/bodies.hpp"
#include "solver/detail/broad_phase.hpp"

namespace pelletlab::solver::detail {

/// Pairs that are worked on together: those of bodies [body_begin, body_end). Their candidates lie together, each pair's padded to a multiple of
/// `candidate_padding`.
struct PairBlock {
    std::uint32_t body_begin = 0, body_end = 0;
    std::uint32_t pair_begin = 0, pair_end = 0;
    static constexpr std::size_t candidate_padding = 4;
    LargeVector<Candidate> candidates;
    LargeVector<Spring> springs;  ///< PairList::spring_rows a candidate
};

/// The pairs themselves: what a rebuild carries over.
struct Pairs {
    NeighbourRows rows;
    LargeVector<PairRecord> records;  ///< by the place of i, then the id of j; i is the one with the smaller id
    std::vector<PairBlock> blocks;    ///< in the order of bodies and pairs
    std::vector<std::uint32_t> block_of_body;
    std::vector<std::uint32_t> place_of_id;  ///< where bodies lay when the list was made
};

struct PairList : Pairs {
    Pairs previous;  ///< of the last rebuild; kept because its memory serves the next one
    NeighbourScratch scratch;
    LargeVector<LoadRow> loads_j;  ///< per pair: what the second body feels, world; valid where touching
    std::vector<std::uint8_t> touching;
    LargeVector<LoadRow> own_loads;  ///< per body: what it feels from the pairs in which it is the first; valid where own_touching
    std::vector<std::uint8_t> own_touching;
    std::vector<std::uint32_t> incoming_first;       ///< where the row of body j in `incoming` begins; one more at the end
    std::vector<Incoming> incoming;                  ///< records and their second body j; a row by the id of i
    std::size_t body_count = 0;                      ///< at the last rebuild
    double skin = 0.0;                               ///< [m], of the body list
    double pair_skin = 0.0;                          ///< [m], usual one of candidate lists
    double hold = 0.0;                               ///< [m], gap up to which spheres that have touched may hold together
    std::size_t spring_rows = 1;                     ///< of history a contact
    std::vector<LoadRow> books;                      ///< per block, where the law books; see BookColumn
    std::vector<LoadRow> pair_books;                 ///< per pair, valid where touching; empty: nobody wants it
    std::uint64_t rebuilds = 0, rebuilt_at = 0;      ///< rebuilt_at: step
    double smallest_skin = 0.0, largest_skin = 0.0;  ///< [m], between which adapt_skin() may choose; both 0: it stays as it is
    double spread = 0.0;                             ///< mean distance in memory between the bodies of a pair
    double ordered_spread = 0.0;                     ///< the same just after bodies were put in order

    /// A wider skin for a list that has lasted only a few steps, a narrower one for a list that has lasted long. Results do not depend on it.
    void adapt_skin(std::uint64_t step) {
        const std::uint64_t lasted = step - rebuilt_at;
        rebuilt_at = step;
        if (lasted < 30 && skin < largest_skin) skin = std::min(1.2 * skin, largest_skin);
        if (lasted > 150 && skin > smallest_skin) skin = std::max(skin / 1.2, smallest_skin);
    }
};

/// Makes the list anew and marks the bodies' reference positions; candidates and history of pairs that stay are carried over.
void rebuild_pairs(PairList& list, Bodies& bodies, const std::vector<BodyTemplate>& templates);

/// Calls visit(record, its block) for all pairs, by the id of i, then of j: an order that does not depend on where bodies lie.
template <class List, class Visit>
void for_each_record(List& list, const Bodies& bodies, const Visit& visit) {
    for (std::size_t id = 0; id < list.body_count; ++id) {
        const std::uint32_t i = bodies.place_of(id);
        for (std::uint32_t k = list.rows.first[i]; k < list.rows.first[i + 1]; ++k) visit(list.records[k], list.blocks[list.block_of_body[i]]);
    }
}

/// Pose of j in the frame of i.
struct RelativePose {
    double p[3];
    double q[4];
};

RelativePose relative_pose(const Kinematic& i, const Kinematic& j);

/// Finds the candidates of a record anew for this relative pose; history is carried over by (sphere a, sphere b).
void refresh_candidates(const PairList& list, PairBlock& block, PairRecord& record, const BodyTemplate& ti, const BodyTemplate& tj, const RelativePose& pose,
                        const Kernels& kernels, std::uint32_t step);

/// True when the list has lasted so long that a smaller skin would do.
inline bool too_generous(const PairRecord& record, double usual_skin, std::uint32_t step) {
    return record.count > 0 && step - record.refreshed > 256 && static_cast<double>(record.skin) > 0.1 * usual_skin;
}

}  // namespace pelletlab::solver::detail
