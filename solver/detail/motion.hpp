// Rigid-body motion of second order. Velocity Verlet for the centre of mass; for rotation a symmetric splitting that keeps the angular momentum L in
// the world frame: without torque L does not change by a single bit, and the free symmetric top is integrated exactly.
//   ½ kick   v += F Δt / 2m,  L += T Δt / 2
//   drift    x += v Δt,  q ← exp(L Δt / I_t) q exp(e_a (1/I_a − 1/I_t) π_a Δt),  π = Rᵀ L
//            (for three different moments half a turn exp(e_s (1/I_s − 1/I_t) π_s Δt/2) from the right before and after)
//   predict  v* = v + F Δt / 2m, L* = L + T Δt / 2: velocities of the same instant as x, which the new force takes
//   ½ kick   with the new force
// The splitting: Dullweber, Leimkuhler, McLachlan 1997 (J. Chem. Phys. 107:5840), with the symmetric top as the solvable part.
// The loops are in motion_kernel_impl.hpp.
#pragma once

#include "core/vec.hpp"
#include "solver/detail/bodies.hpp"

namespace pelletlab::solver::detail {

struct Quaternion {
    double w, x, y, z;
};

inline Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

struct Matrix3 {
    double m[3][3];
};

inline Matrix3 matrix_of(double w, double x, double y, double z) {
    return {{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
             {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
             {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}}};
}

/// The record of body i with its present velocities.
void fill_record(const Bodies& bodies, const BodyTemplate& t, std::size_t i, Kinematic& record);

}  // namespace pelletlab::solver::detail
