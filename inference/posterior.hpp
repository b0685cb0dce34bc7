// Posterior and evidence of one hypothesis: mode by damped Gauss–Newton, then adaptive importance sampling with a Student-t proposal.
// Works for any prediction function; for a linear one with Gaussian prior it agrees with the closed form.
#pragma once

#include <functional>
#include <vector>

#include "inference/gaussian.hpp"

namespace pelletlab::inference {

/// y = f(ψ) + noise; likelihood Gaussian with Σ up to χ² = n and as slow as a Student t beyond (log_heavy_tailed_likelihood). The prior is uniform in the box
/// where prior_deviation is infinite, and normal (mean 0) cut to the box elsewhere.
struct Inference {
    Eigen::VectorXd whitened_data;  ///< C⁻¹ y
    double log_determinant = 0.0;   ///< of Σ
    double nu = 0.0;
    std::function<Eigen::VectorXd(const Eigen::VectorXd& psi)> whitened_mean;  ///< C⁻¹ f(ψ)
    Eigen::VectorXd lower, upper, prior_deviation;
};

struct Mode {
    Eigen::VectorXd psi;
    Eigen::VectorXd residual;   ///< whitened, y − f(ψ)
    Eigen::MatrixXd jacobian;   ///< whitened ∂f/∂ψ at the mode
    Eigen::MatrixXd precision;  ///< curvature of −log posterior, with a floor that spans the box
    std::vector<int> free;      ///< unknowns that are not pressed against their bound: only these follow small changes of the data
    double chi2 = 0.0;
    double weight = 1.0;         ///< of the data in the precision: below 1 when χ² > n
    double log_posterior = 0.0;  ///< not normalised
};

/// Residual of a fit linearised at its mode as a function of whitened noise: M = 1 − w J_f P_ff⁻¹ J_fᵀ, f the free unknowns and w the weight that the heavy
/// tail gives all data alike (it is in P, too: it widens the posterior and leaves what the fit absorbs nearly alone). A bound that holds an unknown keeps it
/// from absorbing noise, so its direction stays in M.
Eigen::MatrixXd residual_operator(const Mode& mode);

/// log prior density, normalised over the box; −∞ outside.
double log_prior(const Inference& problem, const Eigen::VectorXd& psi);

/// Best of the modes reached from the starts.
Mode find_mode(const Inference& problem, const std::vector<Eigen::VectorXd>& starts, int largest_steps = 15);

struct Posterior {
    Mode mode;
    double log_evidence = 0.0;
    double effective_samples = 0.0;
    Eigen::VectorXd mean, deviation, lower, upper;  ///< 90 % interval
    std::vector<Eigen::VectorXd> draws;             ///< equally weighted, for predictions
};

struct SamplingOptions {
    int samples = 128, rounds = 2, draws = 16;
    std::uint64_t seed = 1;
};

Posterior sample_posterior(const Inference& problem, const Mode& mode, const SamplingOptions& options);

/// Evidence from the mode alone (Laplace), box ignored: for hypotheses that only need a rough weight.
double laplace_evidence(const Inference& problem, const Mode& mode);

/// Profile likelihood of unknown i: smallest χ² over the others with ψ_i fixed at each value.
std::vector<double> profile_chi2(const Inference& problem, Eigen::Index i, const std::vector<double>& values, const Eigen::VectorXd& start);

}  // namespace pelletlab::inference
