// Small statistics that every measurement operator shares.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pelletlab::observables {

/// Value below which the fraction of the values lies, with linear interpolation between the two neighbours in order
/// (index fraction · (n − 1); type 7 of Hyndman & Fan 1996). Throws Error(bad_input) for no values.
double percentile(std::vector<double> values, double fraction);

struct LineFit {
    double intercept = 0.0;
    double slope = 0.0;
    std::size_t points = 0;
};

/// Least-squares line y = intercept + slope · x through the points whose y is a number. NaN in both when fewer than two distinct x are left.
LineFit fit_line(std::span<const double> x, std::span<const double> y);

/// Mean of the values that are numbers; NaN when there is none.
double mean_of(std::span<const double> values);

/// Standard error of the mean of a stationary series whose neighbours in time are correlated (Flyvbjerg & Petersen 1989, J. Chem. Phys. 91:461,
/// key flyvbjerg1989): neighbours are averaged in pairs again and again, and the largest s_k / √n_k / c4(n_k) of the levels with n_k ≥ 5 blocks is taken
/// (c4 removes the bias of a standard deviation of few values). For an uncorrelated series of 20 values that lies about a fifth above the true error, on
/// the safe side; for one of only 20 correlation times about a tenth below. Values that are not numbers are left out; NaN when fewer than 5 are left.
double standard_error(std::span<const double> series);

}  // namespace pelletlab::observables
