#include "solver/detail/pair_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "solver/detail/aligned_scratch.hpp"
#include "solver/detail/motion.hpp"

namespace pelletlab::solver::detail {

namespace {

/// A touching pair of the block, waiting for its contact forces.
struct Active {
    std::uint32_t record;
    std::uint32_t first_contact, contact_end;
    double p[3];    ///< place of j in the frame of i
    Matrix3 frame;  ///< frame of i → world
};

/// Scratch of one worker.
struct Scratch {
    BatchStorage storage;
    std::vector<PairSlot> slots;
    std::vector<Active> active;
    std::vector<std::uint32_t> candidate;  ///< of each contact: place in the pool
};

void rotate_back(const Matrix3& m, const double a[3], double out[3]) {  // Rᵀ a
    for (int k = 0; k < 3; ++k) out[k] = m.m[0][k] * a[0] + m.m[1][k] * a[1] + m.m[2][k] * a[2];
}

void rotate(const Matrix3& m, const double a[3], double out[3]) {
    for (int k = 0; k < 3; ++k) out[k] = m.m[k][0] * a[0] + m.m[k][1] * a[1] + m.m[k][2] * a[2];
}

bool stale(const PairRecord& r, const RelativePose& pose, double rho) {
    double shift = 0.0, turn = 0.0;
    for (int k = 0; k < 3; ++k) shift += (pose.p[k] - static_cast<double>(r.place[k])) * (pose.p[k] - static_cast<double>(r.place[k]));
    for (int k = 0; k < 4; ++k) turn += (pose.q[k] - static_cast<double>(r.turn[k])) * (pose.q[k] - static_cast<double>(r.turn[k]));
    return !(std::sqrt(shift) + 2.0 * rho * std::sqrt(turn) <= static_cast<double>(r.allowance));
}

/// Finds the touching spheres of one pair and puts them into the batch. True when there are any.
bool collect(const PairRecord& record, PairBlock& block, const RelativePose& pose, const BodyTemplate& ti, const BodyTemplate& tj, Scratch& s) {
    const Matrix3 r = matrix_of(pose.q[0], pose.q[1], pose.q[2], pose.q[3]);
    const std::size_t before = s.storage.batch.size;
    for (std::size_t k = record.first; k < record.first + std::size_t{record.count}; ++k) {
        Candidate& candidate = block.candidates[k];
        const auto& a = ti.balls[candidate.sphere_a()];
        const auto& b = tj.balls[candidate.b];
        const double dx = r.m[0][0] * b.x + r.m[0][1] * b.y + r.m[0][2] * b.z + pose.p[0] - a.x;
        const double dy = r.m[1][0] * b.x + r.m[1][1] * b.y + r.m[1][2] * b.z + pose.p[1] - a.y;
        const double dz = r.m[2][0] * b.x + r.m[2][1] * b.y + r.m[2][2] * b.z + pose.p[2] - a.z;
        const double d2 = dx * dx + dy * dy + dz * dz;
        const double reach = a.r + b.r;
        if (d2 < reach * reach) {
            const double distance = std::sqrt(d2);
            const double overlap = reach - distance;
            const double inverse = 1.0 / std::max(distance, 1e-300);
            const std::size_t c = s.storage.add();
            ContactBatch& batch = s.storage.batch;
            batch.nx[c] = dx * inverse, batch.ny[c] = dy * inverse, batch.nz[c] = dz * inverse;
            batch.overlap[c] = overlap;
            batch.radius[c] = a.r * b.r / reach;
            const double arm = a.r - 0.5 * overlap;
            batch.x[c] = a.x + batch.nx[c] * arm, batch.y[c] = a.y + batch.ny[c] * arm, batch.z[c] = a.z + batch.nz[c] * arm;
            const Spring& spring = block.springs[k];
            batch.sx[c] = spring.x, batch.sy[c] = spring.y, batch.sz[c] = spring.z;
            batch.slot[c] = static_cast<std::uint32_t>(s.slots.size());
            s.candidate.push_back(static_cast<std::uint32_t>(k));
        } else if (candidate.touching()) {
            block.springs[k] = {};
            candidate.a = candidate.sphere_a();
        }
    }
    return s.storage.batch.size > before;
}

}  // namespace

void pair_contact_forces(PairList& list, std::size_t block_index, const std::vector<Kinematic>& kinematics, const Bodies& bodies,
                         const std::vector<BodyTemplate>& templates, const LawRow& law, const Kernels& kernels, const StepClock& clock) {
    thread_local Scratch s;  // grows once, holds nothing between calls
    s.storage.batch.size = 0;
    s.slots.clear();
    s.active.clear();
    s.candidate.clear();
    PairBlock& block = list.blocks[block_index];
    const std::size_t begin = block_index * PairBlock::pairs_per_block;
    const std::size_t end = std::min(list.records.size(), begin + PairBlock::pairs_per_block);

    for (std::size_t k = begin; k < end; ++k) {
        PairRecord& record = list.records[k];
        const Kinematic &i = kinematics[record.i], &j = kinematics[record.j];
        const BodyTemplate &ti = templates[bodies.template_index[record.i]], &tj = templates[bodies.template_index[record.j]];
        const Matrix3 frame = matrix_of(i.q[0], i.q[1], i.q[2], i.q[3]);
        const double d[3] = {j.p[0] - i.p[0], j.p[1] - i.p[1], j.p[2] - i.p[2]};
        RelativePose pose;
        rotate_back(frame, d, pose.p);
        const Quaternion turn = product({i.q[0], -i.q[1], -i.q[2], -i.q[3]}, {j.q[0], j.q[1], j.q[2], j.q[3]});
        pose.q[0] = turn.w, pose.q[1] = turn.x, pose.q[2] = turn.y, pose.q[3] = turn.z;
        if (stale(record, pose, tj.largest_offset)) refresh_candidates(block, record, ti, tj, pose, list.pair_skin);
        const auto first = static_cast<std::uint32_t>(s.storage.batch.size);
        list.touching[k] = 0;
        if (record.count == 0 || !collect(record, block, pose, ti, tj, s)) continue;

        list.touching[k] = 1;
        const auto contact_end = static_cast<std::uint32_t>(s.storage.batch.size);
        const double v[3] = {j.v[0] - i.v[0], j.v[1] - i.v[1], j.v[2] - i.v[2]};
        const double w[3] = {j.w[0] - i.w[0], j.w[1] - i.w[1], j.w[2] - i.w[2]};
        double v_i[3], w_j[3], j_spin[3];
        rotate_back(frame, v, v_i);
        rotate_back(frame, w, w_j);
        rotate_back(frame, j.w, j_spin);
        PairSlot slot;
        const double* p = pose.p;
        slot.velocity[0] = v_i[0] - (j_spin[1] * p[2] - j_spin[2] * p[1]);
        slot.velocity[1] = v_i[1] - (j_spin[2] * p[0] - j_spin[0] * p[2]);
        slot.velocity[2] = v_i[2] - (j_spin[0] * p[1] - j_spin[1] * p[0]);
        for (int c = 0; c < 3; ++c) slot.spin[c] = w_j[c];
        slot.mass = 1.0 / (i.inverse_mass + j.inverse_mass);
        slot.inertia = rolling_share / ((i.inverse_inertia + j.inverse_inertia) * static_cast<double>(contact_end - first));
        s.slots.push_back(slot);
        s.active.push_back({static_cast<std::uint32_t>(k), first, contact_end, {p[0], p[1], p[2]}, frame});
    }

    s.storage.pad();
    ContactBatch& batch = s.storage.batch;
    kernels.contact_forces(law, batch, s.slots.data(), clock.spring_step, clock.step);

    if (clock.spring_step > 0.0) {
        for (std::size_t c = 0; c < batch.size; ++c) {
            block.springs[s.candidate[c]] = {batch.sx[c], batch.sy[c], batch.sz[c]};
            block.candidates[s.candidate[c]].a |= Candidate::touching_bit;
        }
    }
    for (const Active& pair : s.active) {
        double force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
        for (std::uint32_t c = pair.first_contact; c < pair.contact_end; ++c) {
            force[0] += batch.fx[c], force[1] += batch.fy[c], force[2] += batch.fz[c];
            torque[0] += batch.mx[c], torque[1] += batch.my[c], torque[2] += batch.mz[c];
        }
        // Torque on j about its own centre: the torque about the origin of frame i, moved.
        const double on_j[3] = {torque[0] - (pair.p[1] * force[2] - pair.p[2] * force[1]), torque[1] - (pair.p[2] * force[0] - pair.p[0] * force[2]),
                                torque[2] - (pair.p[0] * force[1] - pair.p[1] * force[0])};
        const double on_i[3] = {-torque[0], -torque[1], -torque[2]};
        PairLoad& load = list.loads[pair.record];
        rotate(pair.frame, force, load.force);
        rotate(pair.frame, on_i, load.torque_i);
        rotate(pair.frame, on_j, load.torque_j);
    }
}

}  // namespace pelletlab::solver::detail
