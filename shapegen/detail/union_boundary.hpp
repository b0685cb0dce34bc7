// The surface of a union of spheres, exactly: on each sphere the exposed part is bounded by circle arcs, and every integral of a polynomial over it
// follows from integrals along those arcs.
//
// On the unit sphere with outward normal n, and ν the outward conormal of the exposed region S:
//     ∫ n dA = −½ ∮ ν ds,   ∫ n nᵀ dA = (A·1 − ∮ ν nᵀ ds)/3,   ∫ n_j n_k (n·c) dA = (c_j M_k + c_k M_j − ∮ n_j n_k (ν·c) ds)/4,  M = ∫ n dA,
// from ∫ (∇_S f − 2 f n) dA = ∮ f ν ds with f = 1, n_j, n_j n_k. The area A is the fan of the arcs seen from a pole, modulo 4π: no topology is needed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen::detail {

/// Piece of the circle in which sphere `sphere` meets sphere `neighbour`, not covered by any third sphere.
/// Point at angle t: centre + radius·(cos_opening·axis + sin_opening·(u cos t + v sin t)), begin ≤ t ≤ end.
struct ExposedArc {
    std::uint32_t sphere = 0, neighbour = 0;
    Vec3 axis = Vec3::UnitZ();  ///< from this sphere's centre to the neighbour's, unit
    Vec3 u = Vec3::UnitX(), v = Vec3::UnitY();
    double cos_opening = 1.0, sin_opening = 0.0;
    double begin = 0.0, end = 0.0;
    bool full_circle = false;
};

/// The part of a sphere that one neighbour hides: all directions n with n·axis > cosine.
struct Cap {
    std::uint32_t neighbour = 0;
    Vec3 axis = Vec3::UnitZ();
    double cosine = 1.0, sine = 0.0;  ///< of the opening angle
};

/// What one sphere shows of itself.
struct ExposedPart {
    double solid_angle = 0.0;             ///< A on the unit sphere; area = radius² A
    Vec3 normal_integral = Vec3::Zero();  ///< M on the unit sphere
    std::vector<ExposedArc> arcs;
    std::vector<Cap> caps;  ///< widest first, without those inside another; empty too for a sphere that is hidden altogether
};

ExposedPart exposed_part(std::span<const Sphere> spheres, std::uint32_t index, std::span<const std::uint32_t> neighbours);

/// All spheres; in parallel, same bits for any number of threads.
std::vector<ExposedPart> union_boundary(std::span<const Sphere> spheres);

/// For each sphere the others that reach its surface or interior, in ascending order.
std::vector<std::vector<std::uint32_t>> overlapping_neighbours(std::span<const Sphere> spheres);

/// Moments of the union about `origin`: volume, ∫ x dV and ∫ x xᵀ dV with x measured from the origin.
struct UnionMoments {
    double volume = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
};

UnionMoments union_moments(std::span<const Sphere> spheres, std::span<const ExposedPart> boundary, const Vec3& origin);

}  // namespace pelletlab::shapegen::detail
