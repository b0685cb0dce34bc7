// What the number-crunching kernels read and write: plain arrays, no Eigen, so that a kernel file can be compiled for a newer
// instruction set without leaking its instructions into inline functions that other files share.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pelletlab::solver::detail {

/// Constants of one pair of materials; see contact_law_impl.hpp for the formulas.
struct LawRow {
    double normal_stiffness = 0.0;    ///< 2 E* [Pa]
    double tangential_ratio = 0.0;    ///< S_t / S_n = 4 G*/E*
    double damping = 0.0;             ///< −2 sqrt(5/6) β ≥ 0, for the normal direction
    double tangential_damping = 0.0;  ///< the same times sqrt(S_t / S_n)
    double sliding_friction = 0.0;
    double rolling_friction = 0.0;
};

/// Motion of a touching pair (i, j) in the frame of i; i may be a wall.
struct alignas(64) PairSlot {
    double velocity[3];  ///< [m/s], v_j − v_i − ω_j × p with p the place of j: velocity of j's material at x is velocity + spin × x
    double spin[3];      ///< [rad/s], ω_j − ω_i
    double mass;         ///< [kg], 1 / (1/m_i + 1/m_j)
    double inertia;      ///< [kg m²], share of the reduced inertia that rolling friction of one contact may stop in one step
};

/// Touching spheres of many pairs, structure of arrays, each array `capacity` long and 64-byte aligned.
struct ContactBatch {
    std::size_t size = 0;
    double *nx, *ny, *nz;  ///< unit normal from i to j
    double* overlap;       ///< [m]
    double* radius;        ///< [m], 1 / (1/r_i + 1/r_j)
    double *x, *y, *z;     ///< [m], contact point
    double *sx, *sy, *sz;  ///< [m], tangential displacement: in and out
    double *fx, *fy, *fz;  ///< [N], out: force on j
    double *mx, *my, *mz;  ///< [N m], out: torque on j about the origin of frame i, rolling friction included
    double* normal_force;  ///< [N], out
    std::uint32_t* slot = nullptr;
};

/// Forces of all contacts of a batch. spring_step: time over which the tangential spring grows; step: time step [s].
using ContactKernel = void (*)(const LawRow& law, ContactBatch& batch, const PairSlot* slots, double spring_step, double step);

struct Kernels {
    const char* name;
    ContactKernel contact_forces;
};

/// The fastest set that this processor runs; all sets give the same bits.
const Kernels& best_kernels();
const Kernels& scalar_kernels();

}  // namespace pelletlab::solver::detail
