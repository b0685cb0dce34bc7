// Covariance of a response with a baseline and effects on spokes:
//   k = c + v_lin φ·φ′ + v_base E(φ,φ′) + Σ_k B_k(θ_k,θ_k′) G(φ,φ′) + v_pair Σ_{k<l} b_k b_l G(φ,φ′) + noise
//   E = exp(−½ Σ (φ_i−φ_i′)²/ℓ_i²),  G the same with lengths stretched by s,  e(t) = exp(−½ t²/ℓ_k²)
//   b_k = θθ′ + e(θ−θ′) − e(θ)e(θ′),   B_k = v_slope θθ′ + v_curve [e(θ−θ′) − e(θ)e(θ′)]
// The bracket is the kernel conditioned on zero at θ = 0 (κ(0,0) = 1), so with θ_k = 0 effect k adds exactly nothing and all blocks share one baseline.
#pragma once

#include <vector>

#include "core/vec.hpp"

namespace pelletlab::inference {

/// Runs in scaled coordinates: φ in [0,1]^p, θ in [−1,1]^K.
struct SpokeInputs {
    Eigen::MatrixXd phi, theta;  ///< runs × p, runs × K
    Eigen::VectorXd scatter;     ///< runs: variance of a run's noise relative to the others
    Eigen::Index runs() const { return phi.rows(); }
    SpokeInputs rows(const std::vector<int>& chosen) const { return {phi(chosen, Eigen::all), theta(chosen, Eigen::all), scatter(chosen)}; }
};

/// Logarithms of the kernel's numbers, one after the other.
struct SpokeLayout {
    Eigen::Index parameters = 0, effects = 0;
    Eigen::Index linear() const { return 0; }
    Eigen::Index base() const { return 1; }
    Eigen::Index length(Eigen::Index i) const { return 2 + i; }
    Eigen::Index slope(Eigen::Index k) const { return 2 + parameters + 3 * k; }
    Eigen::Index curve(Eigen::Index k) const { return slope(k) + 1; }
    Eigen::Index effect_length(Eigen::Index k) const { return slope(k) + 2; }
    Eigen::Index stretch() const { return 2 + parameters + 3 * effects; }
    Eigen::Index pair() const { return stretch() + 1; }
    Eigen::Index noise() const { return stretch() + 2; }
    Eigen::Index size() const { return stretch() + 3; }
    /// Centre and width of the weak log-normal prior of each number, for scores scaled to unit variance.
    Eigen::VectorXd prior_mean() const;
    Eigen::VectorXd prior_width() const;
};

inline constexpr double spoke_constant_variance = 100.0;  // c: the mean is free

/// Covariance matrix of the runs, noise included, and (if asked for) its derivatives by every logarithm.
Eigen::MatrixXd spoke_covariance(const SpokeLayout& layout, const Eigen::VectorXd& logs, const SpokeInputs& x,
                                 std::vector<Eigen::MatrixXd>* derivatives = nullptr);

/// The kernel of one fitted set of numbers against fixed runs, prepared for many evaluations.
class SpokeEvaluator {
public:
    SpokeEvaluator() = default;
    SpokeEvaluator(const SpokeLayout& layout, const Eigen::VectorXd& logs, const SpokeInputs& x);
    /// Covariances of the point (φ, θ) with every run, without noise. Effects with θ_k = 0 are not evaluated at all.
    Eigen::ArrayXd covariances(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const;
    /// Prior variance at the point, without noise.
    double variance(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const;
    double noise() const { return noise_; }

private:
    Eigen::ArrayXd bracket(double theta, Eigen::Index k) const;
    SpokeInputs x_;
    Eigen::ArrayXXd at_zero_;  // e(θ_j), runs × effects
    double linear_ = 0.0, base_ = 0.0, stretch_square_ = 1.0, pair_ = 0.0, noise_ = 0.0;
    Eigen::VectorXd inverse_length_square_, slope_, curve_, effect_inverse_square_;
};

}  // namespace pelletlab::inference
