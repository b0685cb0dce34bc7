// Whitening by a covariance, and the elliptical Student-t density: the likelihood of a diagnosis.
#pragma once

#include "core/random.hpp"
#include "core/vec.hpp"

namespace pelletlab::inference {

/// Σ = C Cᵀ (C lower triangular); whiten(v) = C⁻¹ v, so whitened noise has unit covariance.
class Whitener {
public:
    Whitener() = default;
    /// Throws Error(numerical) when Σ is not positive definite.
    explicit Whitener(const Eigen::MatrixXd& covariance);

    Eigen::VectorXd whiten(const Eigen::VectorXd& v) const;
    Eigen::MatrixXd whiten_columns(const Eigen::MatrixXd& m) const;
    Eigen::VectorXd colour(const Eigen::VectorXd& v) const { return factor_.triangularView<Eigen::Lower>() * v; }
    double log_determinant() const { return log_determinant_; }
    const Eigen::MatrixXd& factor() const { return factor_; }

private:
    Eigen::MatrixXd factor_;
    double log_determinant_ = 0.0;
};

/// log density of the n-dimensional Student t with scale Σ (log determinant given) and ν degrees of freedom at Mahalanobis distance χ² = ‖C⁻¹(y − f)‖²:
/// lnΓ((ν+n)/2) − lnΓ(ν/2) − n/2 ln(νπ) − ½ ln|Σ| − (ν+n)/2 ln(1 + χ²/ν). ν = ∞ is the Gaussian.
double log_student_density(double chi2, Eigen::Index n, double log_determinant, double nu);

/// Likelihood of data whose covariance is trusted for its size and not for its tails: the Gaussian density up to χ² = n, from there on the slower fall of the
/// Student t, −n/2 − (ν+n)/2 ln((ν + χ²)/(ν + n)); value and slope are continuous. A plain Student t would take data that fit better than expected (a reality
/// that does not use up its tolerance) as proof of a smaller scale and weigh every difference by (ν+n)/(ν+χ²) > 1. Not normalised: the factor is the same for
/// all explanations of the same data.
double log_heavy_tailed_likelihood(double chi2, Eigen::Index n, double log_determinant, double nu);
/// −2 ∂/∂χ² of it: 1 inside, (ν+n)/(ν+χ²) outside.
double heavy_tailed_weight(double chi2, Eigen::Index n, double nu);

/// Draw of whitened noise: standard normal times √(ν/χ²_ν), one common factor.
Eigen::VectorXd draw_student(RandomStream& random, Eigen::Index n, double nu);

/// Correlation matrix shrunk to the unit matrix: (1 − s)R + s·1 with Schäfer & Strimmer's 2005 estimate of s. Rows of z are observations of mean 0.
Eigen::MatrixXd shrunk_correlation(const Eigen::MatrixXd& z);

}  // namespace pelletlab::inference
