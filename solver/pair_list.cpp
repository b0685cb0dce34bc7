#include "solver/detail/pair_list.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "solver/detail/motion.hpp"

namespace pelletlab::solver::detail {

namespace {

constexpr std::uint32_t pairs_per_block = 192;  ///< about; a block ends with the row of a body
constexpr Spring no_spring{{0.0, 0.0, 0.0, 0.0}};
constexpr std::size_t most_candidates = 65000;  ///< a record counts them in 16 bits

std::size_t padded(std::size_t count) {
    return (count + PairBlock::candidate_padding - 1) / PairBlock::candidate_padding * PairBlock::candidate_padding;
}

/// Copies candidates and springs of one record from its old block to the end of another.
void carry_over(const PairBlock& from, const PairRecord& old, std::size_t rows, PairBlock& to, PairRecord& fresh) {
    fresh = old;
    fresh.first = static_cast<std::uint32_t>(to.candidates.size());
    fresh.capacity = static_cast<std::uint16_t>(padded(old.count));
    to.candidates.insert(to.candidates.end(), from.candidates.begin() + old.first, from.candidates.begin() + old.first + old.count);
    const auto spring_row = [&](std::size_t candidate) { return from.springs.begin() + static_cast<std::ptrdiff_t>(candidate * rows); };
    to.springs.insert(to.springs.end(), spring_row(old.first), spring_row(old.first + std::size_t{old.count}));
    to.candidates.resize(padded(to.candidates.size()), Candidate{0, 0});
    to.springs.resize(to.candidates.size() * rows, no_spring);
}

/// Owner of the scratch of a CandidateSearch.
class SearchStorage {
public:
    CandidateSearch search{};

    /// Sphere pairs closer than `skin`; gaps are looked at up to `reach` > skin.
    void run(const BodyTemplate& ti, const BodyTemplate& tj, const RelativePose& pose, double skin, double reach, const Kernels& kernels) {
        const std::size_t stride = tj.balls.size() + 2 * widest;
        if (columns_.size() < 4 * stride) {
            columns_.resize(4 * stride);
            index_.resize(stride);
        }
        search.x = columns_.data(), search.y = search.x + stride, search.z = search.y + stride, search.r = search.z + stride;
        search.index = index_.data();
        const Matrix3 r = matrix_of(pose.q[0], pose.q[1], pose.q[2], pose.q[3]);
        for (int i = 0; i < 3; ++i) {
            search.place[i] = pose.p[i];
            for (int k = 0; k < 3; ++k) search.turn[3 * i + k] = r.m[i][k];
        }
        search.extent = std::abs(pose.p[0]) + std::abs(pose.p[1]) + std::abs(pose.p[2]) + ti.bounding_radius + tj.bounding_radius;
        search.skin = skin;
        search.reach = reach;
        if (found_.empty()) found_.resize(1024);
        for (;;) {
            search.found = found_.data();
            search.capacity = found_.size();
            if (kernels.search(columns_of(ti), columns_of(tj), search)) return;
            found_.resize(2 * found_.size());
        }
    }

private:
    std::vector<double> columns_;
    std::vector<std::uint16_t> index_;
    std::vector<Candidate> found_;
};

/// Consecutive bodies, until their pairs are enough for one piece of work.
void cut_into_blocks(Pairs& list, std::size_t body_count) {
    std::size_t used = 0;
    list.block_of_body.resize(body_count);
    for (std::uint32_t i = 0; i < body_count; ++used) {
        if (used == list.blocks.size()) list.blocks.emplace_back();
        PairBlock& block = list.blocks[used];
        block.body_begin = i;
        block.pair_begin = list.rows.first[i];
        while (i < body_count && list.rows.first[i] - block.pair_begin < pairs_per_block && i - block.body_begin < pairs_per_block)
            list.block_of_body[i++] = static_cast<std::uint32_t>(used);
        block.body_end = i;
        block.pair_end = list.rows.first[i];
        block.candidates.clear();
        block.springs.clear();
    }
    list.blocks.resize(used);
}

/// The record that a pair had before, or none.
const PairRecord* record_before(const Pairs& old, std::uint32_t id_i, std::uint32_t id_j) {
    if (id_i >= old.place_of_id.size() || id_j >= old.place_of_id.size()) return nullptr;
    const std::uint32_t i = old.place_of_id[id_i], j = old.place_of_id[id_j];
    for (std::uint32_t k = old.rows.first[i]; k < old.rows.first[i + 1]; ++k)
        if (old.rows.partner[k] == j) return &old.records[k];
    return nullptr;
}

/// Fills the records of a block; what pairs had before is carried over.
void fill_block(PairList& list, PairBlock& block, const Bodies& bodies) {
    const Pairs& old = list.previous;
    thread_local std::vector<const PairRecord*> before;  // scratch
    before.clear();
    std::size_t candidates = 0;
    for (std::uint32_t i = block.body_begin; i < block.body_end; ++i)
        for (std::uint32_t k = list.rows.first[i]; k < list.rows.first[i + 1]; ++k) {
            before.push_back(record_before(old, bodies.id(i), bodies.id(list.rows.partner[k])));
            if (before.back()) candidates += padded(before.back()->count);
        }
    if (candidates > block.candidates.capacity()) {  // some more than is needed now
        block.candidates.reserve(candidates + candidates / 8);
        block.springs.reserve((candidates + candidates / 8) * list.spring_rows);
    }
    for (std::uint32_t i = block.body_begin; i < block.body_end; ++i)
        for (std::uint32_t k = list.rows.first[i]; k < list.rows.first[i + 1]; ++k) {
            PairRecord& record = list.records[k];
            record = PairRecord{{0, 0, 0, 1, 0, 0, 0, -1}, 0, 0, 0, 0, 0, 0, 0, 0.0f, 0};
            if (const PairRecord* found = before[k - block.pair_begin]; found)
                carry_over(old.blocks[old.block_of_body[found->i]], *found, list.spring_rows, block, record);
            record.i = i;
            record.j = list.rows.partner[k];
            record.template_i = static_cast<std::uint16_t>(bodies.template_of(record.i));
            record.template_j = static_cast<std::uint16_t>(bodies.template_of(record.j));
        }
}

}  // namespace

RelativePose relative_pose(const Kinematic& i, const Kinematic& j) {
    const double *a = i.turn(), *b = j.turn();
    const Matrix3 frame = matrix_of(a[0], a[1], a[2], a[3]);
    double d[3];
    for (int k = 0; k < 3; ++k) d[k] = j.position()[k] - i.position()[k];
    RelativePose pose;
    for (int k = 0; k < 3; ++k) pose.p[k] = frame.m[0][k] * d[0] + frame.m[1][k] * d[1] + frame.m[2][k] * d[2];
    const Quaternion turn = product({a[0], -a[1], -a[2], -a[3]}, {b[0], b[1], b[2], b[3]});
    pose.q[0] = turn.w, pose.q[1] = turn.x, pose.q[2] = turn.y, pose.q[3] = turn.z;
    return pose;
}

void refresh_candidates(const PairList& list, PairBlock& block, PairRecord& record, const BodyTemplate& ti, const BodyTemplate& tj, const RelativePose& pose,
                        const Kernels& kernels, std::uint32_t step) {
    const double usual_skin = list.pair_skin;
    const std::size_t rows = list.spring_rows;
    thread_local SearchStorage storage;  // scratch
    thread_local std::vector<Spring> springs;
    const std::uint32_t lasted = step - record.refreshed;
    const double old_skin = static_cast<double>(record.skin);
    double skin = usual_skin;
    if (old_skin > 0.0)
        skin = lasted < 12 ? std::min(2.0 * old_skin, 4.0 * usual_skin) : (lasted > 100 ? std::max(0.5 * old_skin, 0.05 * usual_skin) : old_skin);
    record.skin = static_cast<float>(skin);
    record.refreshed = step;
    const double listed = std::max(skin, 1.01 * list.hold);  // spheres that hold together beyond touching stay listed
    storage.run(ti, tj, pose, listed, std::max({6.0 * skin, usual_skin, 1.5 * listed}), kernels);
    const CandidateSearch& search = storage.search;
    const std::size_t count = search.count;
    if (count > most_candidates)
        throw bad_input("two bodies have more than 65000 pairs of spheres within reach of each other", "use templates with fewer spheres");
    if (count > 0) {
        springs.assign(count * rows, no_spring);
        std::size_t old = record.first;
        const std::size_t old_end = record.first + record.count;
        for (std::size_t k = 0; k < count; ++k) {  // both lists are sorted by key
            while (old < old_end && block.candidates[old].key() < search.found[k].key()) ++old;
            if (old < old_end && block.candidates[old].key() == search.found[k].key()) {
                for (std::size_t row = 0; row < rows; ++row) springs[k * rows + row] = block.springs[old * rows + row];
                search.found[k].a = block.candidates[old].a;
            }
        }
        if (count > record.capacity) {
            const std::size_t capacity = padded(count);
            record.first = static_cast<std::uint32_t>(block.candidates.size());
            record.capacity = static_cast<std::uint16_t>(capacity);
            const std::size_t needed = record.first + capacity;
            if (needed > block.candidates.capacity()) block.candidates.reserve(needed + needed / 8);  // left to itself a vector doubles
            if (needed * rows > block.springs.capacity()) block.springs.reserve((needed + needed / 8) * rows);
            block.candidates.resize(needed, Candidate{0, 0});
            block.springs.resize(needed * rows, no_spring);
        }
        std::copy_n(search.found, count, block.candidates.begin() + record.first);
        std::copy(springs.begin(), springs.end(), block.springs.begin() + static_cast<std::ptrdiff_t>(record.first * rows));
    }
    record.count = static_cast<std::uint16_t>(count);
    for (int k = 0; k < 3; ++k) record.reference[k] = static_cast<float>(pose.p[k]);
    for (int k = 0; k < 4; ++k) record.reference[3 + k] = static_cast<float>(pose.q[k]);
    // The reference pose is kept in float: its rounding is taken off the allowance.
    const double rounding = 2.5e-7 * (std::abs(pose.p[0]) + std::abs(pose.p[1]) + std::abs(pose.p[2]) + 4.0 * tj.largest_offset);
    record.reference[7] = static_cast<float>(std::max(0.0, search.nearest_other * 0.999999 - rounding));
}

void rebuild_pairs(PairList& list, Bodies& bodies, const std::vector<BodyTemplate>& templates) {
    std::swap(static_cast<Pairs&>(list), list.previous);
    find_neighbours(bodies, templates, list.skin, list.rows, list.scratch);
    const std::size_t n = bodies.size(), pair_count = list.rows.partner.size();
    list.records.resize(pair_count);
    list.loads_j.resize(pair_count);
    list.touching.assign(pair_count, 0);
    list.own_loads.resize(n);
    list.own_touching.assign(n, 0);
    cut_into_blocks(list, n);
    list.books.assign(list.blocks.size(), LoadRow{});
    parallel_for(list.blocks.size(), 1, [&](std::size_t index) { fill_block(list, list.blocks[index], bodies); });

    list.incoming_first.assign(n + 1, 0);
    for (const std::uint32_t j : list.rows.partner) ++list.incoming_first[j + 1];
    for (std::size_t j = 0; j < n; ++j) list.incoming_first[j + 1] += list.incoming_first[j];
    list.incoming.resize(pair_count);
    std::vector<std::uint32_t>& next = list.scratch.next;
    next.assign(list.incoming_first.begin(), list.incoming_first.end() - 1);
    list.place_of_id.resize(n);
    for (std::size_t id = 0; id < n; ++id) {
        const std::uint32_t i = list.place_of_id[id] = bodies.place_of(id);
        for (std::uint32_t k = list.rows.first[i]; k < list.rows.first[i + 1]; ++k) list.incoming[next[list.rows.partner[k]]++] = {k, list.rows.partner[k]};
    }

    list.spread = 0.0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::uint32_t k = list.rows.first[i]; k < list.rows.first[i + 1]; ++k)
            list.spread += std::abs(static_cast<double>(i) - static_cast<double>(list.rows.partner[k])) / static_cast<double>(pair_count);

    bodies.mark_reference();
    list.body_count = n;
    ++list.rebuilds;
}

}  // namespace pelletlab::solver::detail
