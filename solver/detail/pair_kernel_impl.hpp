// The kernels over one block of pairs: relative poses, touching spheres, forces, loads. Included by kernel files only.
// L: lanes over pairs and contacts; S: short lanes over the candidates of one pair.
#pragma once

#include "solver/detail/contact_kernel_impl.hpp"
#include "solver/detail/motion_kernel_impl.hpp"
#include "solver/detail/search_kernel_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

/// First cache line of a body: place and turn.
template <class L>
struct PlaceLanes {
    using V = typename L::Real;
    Triple<V> p;
    Turn<V> q;
    V offset;
};

template <class L>
inline PlaceLanes<L> load_places(const Kinematic* const* bodies) {
    const double* rows[L::width];
    for (std::size_t lane = 0; lane < L::width; ++lane) rows[lane] = bodies[lane]->place;
    typename L::Real c[8];
    L::load_rows(rows, c);
    return {{c[0], c[1], c[2]}, {c[3], c[4], c[5], c[6]}, c[7]};
}

template <class L>
void find_poses(const PairBlockView& block, PairScratch& s) {
    using V = typename L::Real;
    for (std::size_t k = 0; k < block.count; k += L::width) {
        const Kinematic *first[L::width], *second[L::width];
        const float* references[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) {
            const PairRecord& r = block.records[k + lane < block.count ? k + lane : block.count - 1];
            __builtin_prefetch(reinterpret_cast<const char*>(block.records) + (k + lane + 6 * L::width) * sizeof(PairRecord));  // also of the next block
            // Bodies of later pairs, and the lists of this one, are on their way while the poses are found.
            const PairRecord& later = block.records[k + lane + 2 * L::width < block.count ? k + lane + 2 * L::width : block.count - 1];
            __builtin_prefetch(block.kinematics[later.j].place);
            __builtin_prefetch(block.kinematics[later.j].motion);
            // Also where a pair has none, so that nothing has to be foretold: the lists of its neighbours lie there.
            __builtin_prefetch(block.candidates + r.first);
            __builtin_prefetch(block.springs + r.first * block.spring_rows);
            __builtin_prefetch(block.springs + r.first * block.spring_rows + 2);
            first[lane] = block.kinematics + r.i;
            second[lane] = block.kinematics + r.j;
            references[lane] = r.reference;
            s.counts[k + lane] = r.count;
        }
        const PlaceLanes<L> i = load_places<L>(first), j = load_places<L>(second);
        V old[8];
        L::load_float_rows(references, old);
        const V zero = L::all(0.0);
        const Rotation<V> frame = rotation_of<L>(i.q.w, i.q.x, i.q.y, i.q.z);
        const Triple<V> p = rotate_back(frame, j.p - i.p);
        const Turn<V> q = product(Turn<V>{i.q.w, zero - i.q.x, zero - i.q.y, zero - i.q.z}, j.q);
        const Triple<V> shift = p - Triple<V>{old[0], old[1], old[2]};
        const V w = q.w - old[3], x = q.x - old[4], y = q.y - old[5], z = q.z - old[6];
        const V moved = L::square_root(dot(shift, shift)) + L::all(2.0) * j.offset * L::square_root(w * w + x * x + y * y + z * z);
        const unsigned stale = L::bits(L::greater(moved, old[7]));
        for (std::size_t lane = 0; lane < L::width; ++lane) s.stale[k + lane] = static_cast<std::uint8_t>((stale >> lane) & 1u);
        const Rotation<V> r = rotation_of<L>(q.w, q.x, q.y, q.z);
        const V first_row[8] = {p.x, p.y, p.z, r.x.x, r.x.y, r.x.z, r.y.x, r.y.y}, second_row[8] = {r.y.z, r.z.x, r.z.y, r.z.z, zero, zero, zero, zero};
        double *targets_1[L::width], *targets_2[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) targets_1[lane] = s.poses[k + lane].row, targets_2[lane] = s.poses[k + lane].row + 8;
        L::store_rows(targets_1, first_row);
        L::store_rows(targets_2, second_row);
    }
}

/// Contacts that began or ended since the last step: sets and clears their bits and clears springs. Rare.
inline void note_changes(const PairBlockView& block, std::size_t first, unsigned touched, unsigned touching, std::size_t lanes, bool keep_history) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const unsigned bit = 1u << lane;
        if ((touched & bit) && !(touching & bit)) {
            block.candidates[first + lane].a = block.candidates[first + lane].sphere_a();
            for (std::size_t row = 0; row < block.spring_rows; ++row) block.springs[(first + lane) * block.spring_rows + row] = {{0.0, 0.0, 0.0, 0.0}};
        }
        if (!(touched & bit) && (touching & bit) && keep_history)
            block.candidates[first + lane].a = static_cast<std::uint16_t>(block.candidates[first + lane].a | Candidate::touching_bit);
    }
}

/// For each set of four bits the places of those that are set, a byte each, the lowest first.
constexpr std::uint32_t set_places[16] = {0, 0, 1, 0x0100, 2, 0x0200, 0x0201, 0x020100, 3, 0x0300, 0x0301, 0x030100, 0x0302, 0x030200, 0x030201, 0x03020100};

/// Puts the touching spheres of pair k into the batch. Sticky: those that touched before count as touching until they are `hold` apart.
template <class S, bool sticky>
inline void collect_contacts(const PairBlockView& block, const PairScratch& s, std::size_t k, ContactBatch& b, std::uint32_t slot, bool keep_history,
                             double hold) {
    using V = typename S::Real;
    const PairRecord& record = block.records[k];
    const Ball *balls_i = block.balls[record.template_i], *balls_j = block.balls[record.template_j];
    const double* pose = s.poses[k].row;
    const Triple<V> p{S::all(pose[0]), S::all(pose[1]), S::all(pose[2])};
    const Rotation<V> r{{S::all(pose[3]), S::all(pose[4]), S::all(pose[5])},
                        {S::all(pose[6]), S::all(pose[7]), S::all(pose[8])},
                        {S::all(pose[9]), S::all(pose[10]), S::all(pose[11])}};
    const Candidate* const candidates = block.candidates;
    const std::size_t end = record.first + std::size_t{record.count};
    for (std::size_t c = record.first; c < end; c += S::width) {
        // Pools are padded, so a full register may be read.
        const double *rows_i[S::width], *rows_j[S::width];
        unsigned touched = 0;
        for (std::size_t lane = 0; lane < S::width; ++lane) {
            const Candidate candidate = candidates[c + lane];
            rows_i[lane] = &balls_i[candidate.a & 0x7fffu].x;
            rows_j[lane] = &balls_j[candidate.b].x;
            touched |= static_cast<unsigned>(candidate.a >> 15) << lane;
        }
        V ball_i[4], ball_j[4];
        S::load_short_rows(rows_i, ball_i);
        S::load_short_rows(rows_j, ball_j);
        const Triple<V> centre{ball_i[0], ball_i[1], ball_i[2]};
        const Triple<V> d = rotate(r, Triple<V>{ball_j[0], ball_j[1], ball_j[2]}) + p - centre;
        V reach = ball_i[3] + ball_j[3];
        if constexpr (sticky) {
            double gap[S::width];
            for (std::size_t lane = 0; lane < S::width; ++lane) gap[lane] = (touched >> lane) & 1u ? hold : 0.0;
            reach = reach + S::load(gap);
        }
        const std::size_t lanes = end - c < S::width ? end - c : S::width;
        const unsigned touching = S::bits(S::greater(reach * reach, dot(d, d))) & ((1u << lanes) - 1u);
        if (touched != touching) note_changes(block, c, touched, touching, lanes, keep_history);
        const std::size_t n = b.size;
        S::store_chosen(b.dx + n, touching, d.x), S::store_chosen(b.dy + n, touching, d.y), S::store_chosen(b.dz + n, touching, d.z);
        S::store_chosen(b.ax + n, touching, centre.x), S::store_chosen(b.ay + n, touching, centre.y), S::store_chosen(b.az + n, touching, centre.z);
        S::store_chosen(b.ra + n, touching, ball_i[3]), S::store_chosen(b.rb + n, touching, ball_j[3]);
        static_assert(S::width <= 4, "set_places is for four lanes");
        // Without branches, as how many touch is hard to foretell: what is written too much is written over.
        const std::uint32_t places = set_places[touching];
        for (std::size_t m = 0; m < S::width; ++m) {
            b.slot[n + m] = slot;
            b.spring[n + m] = static_cast<std::uint32_t>(c) + ((places >> (8 * m)) & 0xffu);
        }
        b.size = n + static_cast<std::size_t>(__builtin_popcount(touching));
    }
}

/// Motion of the touching pairs in the frames of their first bodies.
template <class L>
inline void find_slots(const PairBlockView& block, PairScratch& s, bool whole_inertia) {
    using V = typename L::Real;
    for (std::size_t k = 0; k < s.active_count; k += L::width) {
        const double *line_i[L::width], *line_j[L::width];
        const Kinematic* first[L::width];
        double* targets[L::width];
        double place[3][L::width], contacts[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) {
            const std::size_t a = k + lane < s.active_count ? k + lane : s.active_count - 1;
            const std::uint32_t pair = s.active[a];
            first[lane] = block.kinematics + block.records[pair].i;
            line_i[lane] = first[lane]->motion;
            line_j[lane] = block.kinematics[block.records[pair].j].motion;
            targets[lane] = s.slots[k + lane].row;
            for (int c = 0; c < 3; ++c) place[c][lane] = s.poses[pair].row[c];
            contacts[lane] = whole_inertia ? rolling_share : static_cast<double>(s.first_contact[a + 1] - s.first_contact[a]);
        }
        const PlaceLanes<L> i = load_places<L>(first);
        V mi[8], mj[8];
        L::load_rows(line_i, mi);
        L::load_rows(line_j, mj);
        const Rotation<V> frame = rotation_of<L>(i.q.w, i.q.x, i.q.y, i.q.z);
        const Triple<V> wj{mj[3], mj[4], mj[5]}, p{L::load(place[0]), L::load(place[1]), L::load(place[2])};
        const Triple<V> velocity = rotate_back(frame, Triple<V>{mj[0], mj[1], mj[2]} - Triple<V>{mi[0], mi[1], mi[2]});
        const Triple<V> spin = rotate_back(frame, wj - Triple<V>{mi[3], mi[4], mi[5]});
        const Triple<V> at_origin = velocity - cross(rotate_back(frame, wj), p);
        const V mass = L::all(1.0) / (mi[6] + mj[6]);
        const V inertia = L::all(rolling_share) / ((mi[7] + mj[7]) * L::load(contacts));
        const V out[8] = {at_origin.x, at_origin.y, at_origin.z, spin.x, spin.y, spin.z, mass, inertia};
        L::store_rows(targets, out);
    }
}

/// Sums of the contacts of each touching pair, in their order, turned into the world: what each body of the pair feels.
template <class L>
inline void write_loads(const PairBlockView& block, PairScratch& s, const ContactBatch& b) {
    using V = typename L::Real;
    for (std::size_t a = 0; a < s.active_count; ++a) s.sums[a] = LoadRow{};
    for (std::size_t c = 0; c < b.size; ++c) add_row<L>(s.sums[b.slot[c]].row, b.result[c].row);
    for (std::size_t k = 0; k < s.active_count; k += L::width) {
        const Kinematic* first[L::width];
        const double* rows[L::width];
        double *targets_i[L::width], *targets_j[L::width];
        double place[3][L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) {
            const std::size_t a = k + lane < s.active_count ? k + lane : s.active_count - 1;
            const std::uint32_t pair = s.active[a];
            first[lane] = block.kinematics + block.records[pair].i;
            rows[lane] = s.sums[a].row;
            targets_i[lane] = s.loads_i[k + lane].row;
            targets_j[lane] = block.loads_j[pair].row;
            for (int c = 0; c < 3; ++c) place[c][lane] = s.poses[pair].row[c];
        }
        const PlaceLanes<L> i = load_places<L>(first);
        V sum[8];
        L::load_rows(rows, sum);
        const V zero = L::all(0.0);
        const Rotation<V> frame = rotation_of<L>(i.q.w, i.q.x, i.q.y, i.q.z);
        const Triple<V> force{sum[0], sum[1], sum[2]}, torque{sum[3], sum[4], sum[5]}, p{L::load(place[0]), L::load(place[1]), L::load(place[2])};
        const Triple<V> f = rotate(frame, force), ti = rotate(frame, torque), tj = rotate(frame, torque - cross(p, force));
        const V on_i[8] = {zero - f.x, zero - f.y, zero - f.z, zero - ti.x, zero - ti.y, zero - ti.z, zero, zero};
        const V on_j[8] = {f.x, f.y, f.z, tj.x, tj.y, tj.z, zero, zero};
        L::store_rows(targets_i, on_i);
        L::store_rows(targets_j, on_j);
    }
    for (std::size_t a = 0; a < s.active_count; ++a) {  // pairs are sorted by their first body
        const std::uint32_t i = block.records[s.active[a]].i;
        double* own = block.own_loads[i].row;
        const auto further = L::greater(L::all(static_cast<double>(block.own_touching[i])), L::all(0.0));  // no branch: nobody can foretell it
        for (std::size_t k = 0; k < 8; k += L::width) {
            const V row = L::load(s.loads_i[a].row + k);
            L::store(own + k, L::choose(further, L::load(own + k) + row, row));
        }
        block.own_touching[i] = 1;
    }
}

/// Each contact's share of its pair's load: w_k = d_k / Σ d, so that K equal contacts act as one, and one that begins or ends changes nothing at once.
inline void share_loads(const PairScratch& s, ContactBatch& b) {
    for (std::size_t a = 0; a < s.active_count; ++a) {
        double sum = 0.0;
        for (std::uint32_t c = s.first_contact[a]; c < s.first_contact[a + 1]; ++c) {
            const double overlap = b.ra[c] + b.rb[c] - __builtin_sqrt(b.dx[c] * b.dx[c] + b.dy[c] * b.dy[c] + b.dz[c] * b.dz[c]);
            b.share[c] = overlap > 0.0 ? overlap : 0.0;
            sum += b.share[c];
        }
        const double contacts = static_cast<double>(s.first_contact[a + 1] - s.first_contact[a]);
        for (std::uint32_t c = s.first_contact[a]; c < s.first_contact[a + 1]; ++c) b.share[c] = sum > 0.0 ? b.share[c] / sum : 1.0 / contacts;
    }
}

inline void book_pairs(const PairBlockView& block, const PairScratch& s, const ContactBatch& b) {
    for (std::size_t a = 0; a < s.active_count; ++a) {
        LoadRow& sum = block.pair_books[s.active[a]];
        for (double& column : sum.row) column = 0.0;
        for (std::uint32_t c = s.first_contact[a]; c < s.first_contact[a + 1]; ++c)
            for (int k = 0; k < 8; ++k) sum.row[k] += b.book[c].row[k];
    }
}

template <class L, class S, bool sticky>
void pair_forces(ContactKernel contact, const LawRow& law, const PairBlockView& block, PairScratch& s, ContactBatch& b, const StepClock& clock) {
    const bool keep_history = clock.spring_step > 0.0;
    b.size = 0;
    b.springs = block.springs;
    s.active_count = 0;
    s.first_contact[0] = 0;
    for (std::size_t i = block.body_begin; i < block.body_end; ++i) block.own_touching[i] = 0;
    if (law.booked)
        for (double& column : block.book->row) column = 0.0;
    for (std::size_t k = 0; k < block.count; ++k) block.touching[k] = 0;
    for (std::size_t n = 0; n < s.listed_count; ++n) {
        const std::uint32_t k = s.listed[n];
        const std::size_t before = b.size;
        collect_contacts<S, sticky>(block, s, k, b, s.active_count, keep_history, law.reach);
        const std::uint32_t touches = b.size > before ? 1u : 0u;
        block.touching[k] = static_cast<std::uint8_t>(touches);
        __builtin_prefetch(block.loads_j + k, 1);
        s.active[s.active_count] = k;
        s.active_count += touches;
        s.first_contact[s.active_count] = static_cast<std::uint32_t>(b.size);
    }
    if (b.size == 0) return;
    find_slots<L>(block, s, block.spring_rows > 1);
    if (law.shared) share_loads(s, b);
    contact(law, b, s.slots, clock);
    if (law.booked) {
        for (std::size_t c = 0; c < b.size; ++c)
            for (int k = 0; k < 8; ++k) block.book->row[k] += b.book[c].row[k];
        if (block.pair_books != nullptr) book_pairs(block, s, b);
    }
    write_loads<L>(block, s, b);
}

template <class L, bool rich>
struct ContactKernels {
    template <class Law>
    static constexpr ContactKernel of(std::size_t rolling) {
        return rolling == 0   ? &contact_forces<L, Law, RollingConstantTorque, rich>
               : rolling == 1 ? &contact_forces<L, Law, RollingViscous, rich>
                              : &contact_forces<L, Law, RollingElasticPlastic, rich>;
    }
};

template <class L, class S>
constexpr Kernels make_kernels(const char* name) {
    Kernels k{name, &drift<L>, &gather<L>, &search_candidates<L>, &find_poses<L>, &pair_forces<L, S, false>, &pair_forces<L, S, true>, {}, {}};
    for (std::size_t rolling = 0; rolling < rolling_model_count; ++rolling) {
        using Plain = ContactKernels<L, false>;
        using Rich = ContactKernels<L, true>;
        k.plain[0][rolling] = Plain::template of<HertzMindlinEdem>(rolling);
        k.plain[1][rolling] = Plain::template of<HertzMindlinImpulseExact>(rolling);
        k.plain[2][rolling] = Plain::template of<LinearSpringDashpot>(rolling);
        k.plain[3][rolling] = Plain::template of<Viscoelastic>(rolling);
        k.rich[0][rolling] = Rich::template of<HertzMindlinEdem>(rolling);
        k.rich[1][rolling] = Rich::template of<HertzMindlinImpulseExact>(rolling);
        k.rich[2][rolling] = Rich::template of<LinearSpringDashpot>(rolling);
        k.rich[3][rolling] = Rich::template of<Viscoelastic>(rolling);
    }
    return k;
}

}  // namespace
}  // namespace pelletlab::solver::detail
