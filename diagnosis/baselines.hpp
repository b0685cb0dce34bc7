// Simple rules that the diagnosis has to beat on the same cases: each ranks the library's effects, best first.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

struct BaselineRanking {
    std::string rule;
    std::vector<int> effects;  ///< library indices, best first; empty: «no effect»
};

/// largest residual · nearest signature raw · nearest signature after the baseline's fit · smooth discrepancy and nearest signature · smallest χ² ·
/// parameters only · LASSO on signatures · sign table. (Random is 1/K and needs no run.)
std::vector<BaselineRanking> baseline_rankings(const Attributor& attributor, const Eigen::VectorXd& y, const Attribution& attribution);

}  // namespace pelletlab::diagnosis
