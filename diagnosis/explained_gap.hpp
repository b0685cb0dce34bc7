// Where the gap lies according to its explanation: what the weighed explanations predict that the calibrated baseline misses, group by group. All data speak
// for the explanation, so this sees gaps that one group alone cannot show; it is as right as the explanation is.
#pragma once

#include <vector>

#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

struct ExplainedGap {
    double gap = 0.0, lower = 0.0, upper = 0.0;  ///< posterior mean and 90 % interval of the group's mean gap, over explanations and their unknowns
    double probability = 0.0;                    ///< P(S_g > 1 | data), S_g = Σ_{i in g} (gap_i/σ_i)², σ_i the standard deviation of one datum
    bool discovery = false;
};

/// One a group of the fitted data. The gap of a draw ψ of explanation H is M·(f_H(ψ) − f_0(φ̂)) (M: residual_operator of the baseline's fit, so what another
/// calibration would absorb is none), zero under «parameters only», and with its distortion under «none of these». Discoveries: the largest set of groups whose
/// mean 1 − P is at most q (the posterior expected share of false discoveries; Newton et al. 2004), a false one being a group with S_g ≤ 1 in truth.
std::vector<ExplainedGap> explained_gaps(const Attributor& attributor, const Eigen::VectorXd& y, const Attribution& attribution, double q, std::uint64_t seed);

}  // namespace pelletlab::diagnosis
