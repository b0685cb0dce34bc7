// Where the gap lies after the baseline's best joint fit: per observable, region and regime, in physical units, false discoveries controlled.
#pragma once

#include "core/diagnosis.hpp"
#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

/// Groups of the fitted data: mean gap with 90 % interval; D_g² = r_gᵀ V_gg⁺ r_g on directions of V = (1 − H)(1 − H)ᵀ with eigenvalue above 0.15; p value from
/// `draws` parametric bootstrap samples with the fit linearised; Benjamini–Hochberg at the experiment's rate; and the standardised miss when the group is left
/// out.
std::vector<DiagnosisWhere> locate(const Attributor& attributor, const Eigen::VectorXd& y, const Fit& baseline, int draws, std::uint64_t seed,
                                   bool leave_out = true);

/// Miss of the data that were not calibrated on, after a fit to those that were: p value of T = dᵀ(S)⁻¹d/n under Σ and the fit's uncertainty. NaN when
/// nothing, or everything, is marked as calibration.
double transfer_p_value(const Attributor& attributor, const Eigen::VectorXd& y, int draws, std::uint64_t seed);

}  // namespace pelletlab::diagnosis
