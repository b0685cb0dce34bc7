// What to measure next: expected information about «which explanation» per cost.
#pragma once

#include "core/diagnosis.hpp"
#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

/// U(d) = I(H; y_d | y) = Σ_k p_k E[ln p(y_d|H_k) − ln Σ_l p_l p(y_d|H_l)] by 150 draws a candidate from Gaussian predictives N(m_k, S_k): spread of the
/// posterior draws plus Σ of the new data; the open class takes the baseline's predictive with fourfold covariance. Best per cost first. Throws
/// Error(bad_input) for a candidate that names what the campaign does not have.
std::vector<DiagnosisNext> recommend(const Attributor& attributor, const Attribution& attribution, std::uint64_t seed);

}  // namespace pelletlab::diagnosis
