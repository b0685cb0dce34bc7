// Where the gap lies after the baseline's best joint fit: per observable, region and regime, in physical units, false discoveries controlled.
#pragma once

#include "core/diagnosis.hpp"
#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

/// Groups of the fitted data, each judged by its own data: mean gap with 90 % interval; largest standardised shift z² along a few directions named beforehand
/// (a common shift; the signature of each effect after recalibration, with its sign where the effect has one), matched filters z = s_gᵀV_gg⁺r_g/√(s_gᵀV_gg⁺s_g)
/// on directions of V = M Mᵀ (M: residual_operator) with eigenvalue above 0.15; p value from `draws` parametric bootstrap samples with the fit linearised;
/// Benjamini–Hochberg at the experiment's rate; and the standardised miss when the group is left out.
std::vector<DiagnosisWhere> locate(const Attributor& attributor, const Eigen::VectorXd& y, const Fit& baseline, int draws, std::uint64_t seed,
                                   bool leave_out = true);

/// Miss of the data that were not calibrated on, after a fit to those that were: p value of T = dᵀ(S)⁻¹d/n under Σ and the fit's uncertainty. NaN when
/// nothing, or everything, is marked as calibration.
double transfer_p_value(const Attributor& attributor, const Eigen::VectorXd& y, int draws, std::uint64_t seed);

}  // namespace pelletlab::diagnosis
