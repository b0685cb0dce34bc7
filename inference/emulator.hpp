// The simulator's mean response over calibration parameters and effects, from a few hundred runs: POD scores, one Gaussian process each, and an error
// model measured by leaving whole points of the parameter space out.
#pragma once

#include <vector>

#include "inference/gaussian_process.hpp"
#include "inference/pod.hpp"
#include "inference/scatter_model.hpp"

namespace pelletlab::inference {

struct TrainingRuns {
    SpokeInputs inputs;
    Eigen::MatrixXd output;  ///< runs × outputs
    std::vector<int> point;  ///< runs at one point φ have one number: they are left out together
};

struct EmulatorOptions {
    double keep = 0.9995;  ///< share of the weighted variance in the basis
    int largest_modes = 12;
    int largest_pairs = 90;  ///< runs with two effects that are used, spread evenly over the campaign's order
};

/// How good the emulator is, from leave-one-point-out errors. `accepted`: the rms within 0.5 – 2 and fewer than 2 % beyond three. The error itself is part of
/// every covariance, so a poor emulator costs power and not honesty.
struct EmulatorReport {
    int runs = 0, spoke_runs = 0, pair_runs = 0, modes = 0;
    double kept_variance = 0.0;
    double standardised_rms = 0.0;    ///< before the error model is rescaled: 1 is right
    double share_beyond_three = 0.0;  ///< of standardised errors after rescaling, < 0.02
    double share_small = 0.0;         ///< outputs whose left-out error (scatter of the left-out run included) is below half of the scale that matters
    double edge_rms = 0.0;            ///< of errors at left-out points on the edge of the runs' range (a smallest or largest parameter), standardised as stated
    double inner_rms = 0.0;           ///< of errors at the others: √(ν/(ν − 2)) is right for both
    double nu = 0.0;                  ///< degrees of freedom of the error's Student t
    double smallest_scatter = 1.0, largest_scatter = 1.0;  ///< standard deviation of single runs relative to the campaign's middle
    bool accepted = false;
};

class Emulator {
public:
    Emulator() = default;
    /// weight[j] = 1 / (scale that matters of output j). Throws Error(bad_input) when there are fewer spoke runs than twice the parameters and effects.
    Emulator(const TrainingRuns& runs, const Eigen::VectorXd& weight, const EmulatorOptions& options = {});

    const PodBasis& basis() const { return basis_; }
    Eigen::VectorXd scores(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const;
    Eigen::VectorXd field(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const { return basis_.field(scores(phi, theta)); }

    /// Covariance of the scores' error at a point; with `one_run` the scatter of a single run is in it.
    Eigen::MatrixXd score_covariance(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta, bool one_run) const;
    /// Covariance of what the basis cannot make (outputs × outputs), scaled with the scatter of single runs at the point.
    Eigen::MatrixXd rest_covariance(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const { return scatter_.relative(phi, theta) * rest_; }
    /// The same emulator (kernel and error model kept) that never saw the runs at this point: what it says there is a prediction.
    Emulator without_point(int point) const;
    double nu() const { return report_.nu; }
    const EmulatorReport& report() const { return report_; }

private:
    PodBasis basis_;
    std::vector<GaussianProcess> processes_;
    Eigen::VectorXd error_scale_;
    std::vector<ScatterModel> own_;     ///< of each mode's standardised left-out errors
    ScatterModel scatter_, left_over_;  ///< of the runs' noise; of what the standardised left-out errors of all modes together still show
    std::vector<int> point_;            ///< of each run that was used
    Eigen::MatrixXd correlation_, rest_;
    EmulatorReport report_;
};

}  // namespace pelletlab::inference
