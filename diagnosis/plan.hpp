// Before any data are judged: which effects can these data see at all, which cannot be told apart, where would calibration hide a gap.
#pragma once

#include "core/diagnosis.hpp"
#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

/// λ of hypothesis h at (φ, θ) against the best that hypothesis `rival` can do: min over the rival's ψ of ‖C⁻¹(f(φ,θ) − f(ψ))‖², C from Σ at the truth.
double separation(const Attributor& attributor, const Eigen::VectorXd& phi, const Eigen::VectorXd& theta, std::size_t rival);

/// Index of the hypothesis with exactly these effects.
std::size_t hypothesis_index(const std::vector<Hypothesis>& hypotheses, const std::vector<int>& effects);

/// Measured values are not used. `points` places in the parameters' range are averaged over (median).
DiagnosisPlan make_plan(const Attributor& attributor, int points = 5);

}  // namespace pelletlab::diagnosis
