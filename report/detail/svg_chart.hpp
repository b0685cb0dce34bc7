// Small charts of a diagnosis as inline SVG.
#pragma once

#include <string>

#include "core/diagnosis.hpp"

namespace pelletlab::report::detail {

std::string escaped(const std::string& text);

/// Measured points with error bars, baseline and explanation as lines, the gap between measured and baseline filled.
std::string profile_chart(const DiagnosisCurve& curve);
/// Probability of each effect, of «parameters only» and of «none of these», with the threshold as a line.
std::string probability_bars(const Diagnosis& diagnosis);
/// Before, after, placebo and noise as bars in tolerances, fitted and held out.
std::string budget_bars(const Diagnosis& diagnosis);

}  // namespace pelletlab::report::detail
