// Which explanation: parameters only, each effect, pairs of effects, or none of these. Evidence by integration over everything unknown, and an absolute
// test of whether the best explanation is good enough at all.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/problem.hpp"
#include "inference/posterior.hpp"

namespace pelletlab::diagnosis {

/// Prior masses (shared evenly inside a class, suspects threefold) and the width of θ's half-normal prior.
struct Priors {
    double none = 0.30, single = 0.40, pair = 0.15, open = 0.15;
    double amplitude = 0.55;
};

/// An explanation: a set of library effects, or the open class (effects empty, open true).
struct Hypothesis {
    std::vector<int> effects;  ///< library indices
    bool open = false;
    std::string name;
    double log_prior = 0.0;
};

std::vector<Hypothesis> make_hypotheses(const Problem& problem, const Priors& priors = {});

/// A hypothesis fitted to the data: whitened with its own Σ at its own mode.
struct Fit {
    inference::Whitener whitener;
    inference::Mode mode;
    inference::Posterior posterior;
    double log_evidence = 0.0;
    Eigen::MatrixXd distortion;  ///< open class: δ = distortion · a, a ~ N(0, 1), at the most probable width; points × directions
};

/// What is computed once for all cases that share model, design and library: starting clouds and the reduced operator.
class Attributor {
public:
    explicit Attributor(const Problem& problem, const Priors& priors = {});

    const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }
    const Problem& problem() const { return *problem_; }
    Eigen::Index data() const { return problem_->fitted.value.size(); }

    /// ψ = (φ, θ of the hypothesis' effects) in one vector → φ and full θ.
    void split(const Hypothesis& h, const Eigen::VectorXd& psi, Eigen::VectorXd& phi, Eigen::VectorXd& theta) const;
    Eigen::VectorXd mean(const Hypothesis& h, const Eigen::VectorXd& psi) const;

    /// Evidence and posterior of one hypothesis for data y. `sample` false: mode and Laplace evidence only.
    Fit fit(std::size_t hypothesis, const Eigen::VectorXd& y, bool sample = true) const;
    /// The same with parts of the data only (rows), for leave-one-group-out.
    Fit fit_rows(std::size_t hypothesis, const Eigen::VectorXd& y, const std::vector<int>& rows) const;

    inference::Inference inference_of(const Hypothesis& h, const Eigen::VectorXd& y, const inference::Whitener& whitener, const std::vector<int>& rows) const;

private:
    Fit fit_closed(std::size_t hypothesis, const Eigen::VectorXd& y, const std::vector<int>& rows, bool sample) const;
    Fit fit_open(const Eigen::VectorXd& y) const;
    Eigen::MatrixXd covariance_at(const Hypothesis& h, const Eigen::VectorXd& psi, const std::vector<int>& rows) const;

    const Problem* problem_;
    Priors priors_;
    std::vector<Hypothesis> hypotheses_;
    std::vector<int> all_rows_;
    Eigen::VectorXd mean_;   ///< operator · basis mean
    Eigen::MatrixXd modes_;  ///< operator · basis modes
    struct Cloud {
        std::vector<Eigen::VectorXd> psi;
        Eigen::MatrixXd prediction;  ///< data × points
    };
    std::vector<Cloud> clouds_;
    inference::Whitener rough_;
};

/// Absolute test of a fitted hypothesis.
struct Adequacy {
    double p = 1.0;  ///< smallest Holm-adjusted p value over the families
    std::string family;
    struct Part {
        std::string family;
        double statistic, p;
    };
    std::vector<Part> parts;
};

/// Whitened noise of the fitted data, a column a draw.
Eigen::MatrixXd noise_draws(const Problem& problem, int draws, std::uint64_t seed, std::uint64_t stream);

/// Score test on every family of generic distortions, on the whole χ² and on what the basis cannot make; reference by parametric bootstrap from the columns of
/// `noise` with the fit linearised at its mode; Holm over families.
Adequacy test_adequacy(const Problem& problem, const Fit& fit, const Eigen::MatrixXd& noise);

struct Attribution {
    std::vector<Fit> fits;  ///< one a hypothesis
    std::vector<double> log_evidence, probability;
    std::vector<double> inclusion;  ///< P_k of each library effect
    double probability_of_open = 0.0, probability_of_none = 0.0;
    std::vector<int> credible_set;  ///< hypotheses, most probable first, with at least 90 %
    int best_closed = 0;            ///< most probable hypothesis that is not open
    Adequacy adequacy;              ///< of best_closed
    Adequacy baseline_adequacy;     ///< of «parameters only»
};

/// p(H|y) ∝ p(H) p(y|H)^{1/T}.
void normalise(Attribution& attribution, const std::vector<Hypothesis>& hypotheses, double temperature, Eigen::Index effects);

Attribution attribute(const Attributor& attributor, const Eigen::VectorXd& y, double temperature, int bootstrap, std::uint64_t seed);

}  // namespace pelletlab::diagnosis
