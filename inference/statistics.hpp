// Distributions, multiple testing and calibration scores: small closed forms that the statistics of a diagnosis stand on.
#pragma once

#include <cstdint>
#include <vector>

#include "core/random.hpp"
#include "core/vec.hpp"

namespace pelletlab::inference {

double normal_cdf(double x);
/// Inverse of normal_cdf (Acklam's rational start, one Halley step: error < 1e-14). p in (0, 1).
double normal_quantile(double p);
/// P(χ²_k > x), k > 0 degrees of freedom (regularised incomplete gamma function, series and continued fraction).
double chi_squared_survival(double x, double k);
/// χ² with k (a positive number) degrees of freedom: Marsaglia & Tsang 2000.
double draw_chi_squared(RandomStream& random, double k);

/// Benjamini & Hochberg 1995: which hypotheses are discoveries at false discovery rate q. With `dependent`, Benjamini & Yekutieli 2001: q / Σ 1/i.
std::vector<bool> false_discovery_control(const std::vector<double>& p, double q, bool dependent = false);
/// Newton, Noueiry, Sarkar & Ahlquist 2004: the largest set whose mean posterior probability of being false, `doubt`, is at most q.
std::vector<bool> expected_false_discovery_control(const std::vector<double>& doubt, double q);
/// Holm 1979: p values adjusted for the family, each in [p, 1].
std::vector<double> holm(const std::vector<double>& p);

/// p value of `observed` among reference draws of the same statistic, (1 + #{reference ≥ observed}) / (1 + n).
double reference_p_value(double observed, const std::vector<double>& reference);
/// Quantile by linear interpolation between order statistics; the values need not be sorted.
double quantile(std::vector<double> values, double p);

/// Point i (from 1) of the Halton sequence in [0,1)^dimensions, at most 40 dimensions.
Eigen::VectorXd halton(std::uint64_t i, int dimensions);

/// Weighted quantile: smallest value whose cumulated weight reaches p of the total.
double weighted_quantile(std::vector<std::pair<double, double>> value_and_weight, double p);

/// Expected calibration error: Σ over equal-width bins of (n_b/n)·|mean probability − share of true|, and the Brier score mean (p − truth)².
struct CalibrationScore {
    double expected_error = 0.0, brier = 0.0, climatology_brier = 0.0;
    struct Bin {
        int count = 0;
        double mean_probability = 0.0, share_true = 0.0;
    };
    std::vector<Bin> bins;
};
CalibrationScore calibration_score(const std::vector<double>& probability, const std::vector<bool>& truth, int bins = 10);

/// Share with its 90 % interval (Wilson).
struct Share {
    double value = 0.0, lower = 0.0, upper = 1.0;
    int hits = 0, count = 0;
};
Share share_of(int hits, int count);

}  // namespace pelletlab::inference
