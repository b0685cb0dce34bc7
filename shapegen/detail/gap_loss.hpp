// First direction of the fit: weighted mean over points p of the body's surface of φ(p)², φ(p) = min_i |p − c_i| − r_i. The nearest sphere is frozen within one
// evaluation; that is the exact gradient, because φ is continuous where the nearest sphere changes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/rigid_template.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/detail/gap_shape.hpp"
#include "shapegen/detail/nearest_kernel.hpp"
#include "shapegen/detail/sample_blocks.hpp"

namespace pelletlab::shapegen::detail {

using Eigen::VectorXd;  ///< four unknowns a sphere: centre, radius

VectorXd pack(std::span<const Sphere> spheres);
std::vector<Sphere> unpack(const VectorXd& x);

/// Blocks of the Gauss–Newton matrix, one 4×4 a sphere, damped and inverted, plus a few rank-one terms s v vᵀ: the metric of the minimiser.
struct BlockMetric {
    std::vector<Eigen::Matrix4d> blocks;
    std::vector<VectorXd> rows;      ///< v of the rank-one terms
    std::vector<double> scales;      ///< s > 0
    void factorise(double damping);  ///< damping relative to the mean diagonal
    void apply(VectorXd& q) const;   ///< q ← M⁻¹ q (Sherman & Morrison 1950)

private:
    std::vector<Eigen::Matrix4d> inverse_;
    std::vector<VectorXd> solved_;  // M_k⁻¹ v_k, M_k the metric with the terms before k
    std::vector<double> factor_;
    void apply_first(VectorXd& q, std::size_t terms) const;
};

/// A sphere reaches out of the body by r + φ_B(c). The gaps do not see that beyond an edge, where no surface point is near; so reaching out by more than
/// `slack` costs (r + φ_B(c) − slack)² / (number of all spheres) · 2.
struct Containment {
    const meshes::SignedDistance* distance = nullptr;  ///< none: spheres may reach out anywhere
    double slack = 0.0;
};

/// The loss over all points and spheres, or over some points with some spheres free to move.
class GapLoss {
public:
    GapLoss(const SampleBlocks& samples, std::span<const Sphere> spheres);
    /// Only these spheres move and only these blocks count.
    GapLoss(const SampleBlocks& samples, std::span<const Sphere> spheres, std::vector<std::uint32_t> free_spheres, std::vector<std::uint32_t> blocks);

    void contain(const Containment& containment) { containment_ = containment; }
    void charge_by(const GapShape& shape) { shape_ = shape; }

    /// x holds the free spheres. Returns Σ w f(φ) / (number of all points), f(φ) = φ² unless charge_by() says otherwise; fills gradient, and the metric when
    /// wanted.
    double evaluate(const VectorXd& x, VectorXd* gradient, BlockMetric* metric);

    double gap_part() const { return gap_part_; }  ///< of the last evaluation, without the containment

    /// Of the last evaluation, one a point of the counted blocks in order.
    const std::vector<double>& gaps() const { return gap_; }
    const std::vector<std::uint32_t>& nearest() const { return nearest_; }
    std::span<const std::uint32_t> candidates(std::size_t k) const { return {candidate_.data() + start_[k], start_[k + 1] - start_[k]}; }
    const std::vector<std::uint32_t>& blocks() const { return blocks_; }
    const std::vector<std::uint32_t>& free_spheres() const { return free_; }
    VectorXd free_values() const;
    void set_free_values(const VectorXd& x) { set_spheres(x); }
    void copy_spheres(std::vector<Sphere>& spheres) const { spheres = spheres_; }
    double margin() const { return margin_; }

private:
    void set_spheres(const VectorXd& x);
    void to_single(std::size_t i);
    void rebuild_candidates();
    bool candidates_valid() const;
    double add_containment(VectorXd* gradient, BlockMetric* metric);

    const SampleBlocks& samples_;
    struct Known {  // a place where the body's distance was asked for
        Vec3 at = Vec3::Zero();
        double distance = std::numeric_limits<double>::infinity();
    };

    Containment containment_;
    GapShape shape_;
    std::vector<Known> known_;  // one a free sphere
    std::vector<Sphere> spheres_;
    std::vector<Sphere> reference_;  // when the candidates were collected
    SphereArrays arrays_;
    std::vector<std::uint32_t> free_, blocks_;
    std::vector<std::int32_t> slot_;  // of each sphere among the free ones, or −1
    std::vector<std::uint32_t> start_, candidate_;
    double margin_ = 0.0;
    double last_rms_ = 0.0, gap_part_ = 0.0;
    std::vector<double> gap_;
    std::vector<float> gap_single_;
    std::vector<std::uint32_t> nearest_;
};

}  // namespace pelletlab::shapegen::detail
