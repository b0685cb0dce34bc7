// The signature table of a campaign: by how much each effect moves each observable, measured in the scatter of single runs. It replaces what the literature
// lets expect.
#pragma once

#include <string>
#include <vector>

#include "core/campaign.hpp"

namespace pelletlab::diagnosis {

/// Move of one observable (the mean over a profile) in one regime by one effect at θ = 1, averaged over the range of the calibration parameters.
struct SignatureEntry {
    double move = 0.0;            ///< in the observable's unit
    double in_scatter = 0.0;      ///< move / scatter of single runs
    double error = 0.0;           ///< standard error of in_scatter, of the regression alone
    bool is_significant = false;  ///< |move| above the two-sided 99 % point of Student's t: one in a hundred entries of a dead effect is marked
};

struct SignatureRow {
    std::string observable, regime, unit;
    double scatter = 0.0;  ///< standard deviation of single runs with one configuration [unit]
    double tolerance = 0.0;
    std::vector<SignatureEntry> effects;  ///< in the campaign's order
};

struct SignatureTable {
    std::vector<std::string> effects;
    std::vector<int> runs;  ///< configurations with that effect alone
    std::vector<SignatureRow> rows;
    int configurations = 0, repeats = 0;  ///< repeats: degrees of freedom behind the scatter
    bool scatter_from_repeats = false;    ///< false: from the residuals of the regression, because nothing was repeated
};

/// Least squares on configurations with at most one effect: y = c₀ + Σ c_i φ_i + Σ c_ij φ_i φ_j + Σ_k g_k θ_k; the quadratic terms are left out when there are
/// fewer than twice as many baseline configurations as terms. The scatter is pooled over repeated configurations; errors come from the residuals, so what the
/// quadratic cannot follow counts as error. Throws Error(bad_input) when there are fewer configurations than terms and two more.
SignatureTable signature_table(const Campaign& campaign);

}  // namespace pelletlab::diagnosis
