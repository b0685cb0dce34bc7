// Two means from few repeats: how far apart they are, whether that could be chance, and whether they are close enough to be called equal.
#pragma once

#include <vector>

namespace pelletlab::inference {

/// P(T ≤ t) and its inverse for Student's t with `degrees` > 0 degrees of freedom, not necessarily whole.
double student_cdf(double t, double degrees);
double student_quantile(double p, double degrees);

/// Mean and standard deviation (n − 1 in the denominator) of repeats; the deviation of a single one is NaN.
struct Repeats {
    double mean = 0.0;
    double deviation = 0.0;
    int count = 0;
};
Repeats repeats_of(const std::vector<double>& values);

/// a − b by Welch 1947: standard error √(s_a²/n_a + s_b²/n_b), degrees of freedom after Satterthwaite. Where one side has a single value, the other's deviation
/// stands for both (`pooled`), with its n − 1 degrees.
struct MeanDifference {
    double value = 0.0, standard_error = 0.0, degrees = 0.0;
    double lower = 0.0, upper = 0.0;  ///< at the confidence asked for
    double p = 1.0;                   ///< of a difference at least as large when the means are equal, two-sided
    bool pooled = false;
};
/// Throws Error(bad_input) when neither side has a deviation, for a count below 1 and a deviation below 0.
MeanDifference mean_difference(const Repeats& a, const Repeats& b, double confidence = 0.95);

/// Two one-sided tests (Schuirmann 1987) that |difference| < margin: p is the larger of the two; below `level` the means are equivalent, which is the same as a
/// 1 − 2·level interval inside (−margin, margin).
struct Equivalence {
    double margin = 0.0, p = 1.0, lower = 0.0, upper = 0.0;  ///< the interval
    bool equivalent = false;
};
Equivalence test_equivalence(const MeanDifference& difference, double margin, double level = 0.05);

/// What may be said of two means. «differs»: beyond the margin, or beyond chance without being equivalent.
enum class Agreement { equivalent, differs, undecided };
Agreement agreement_of(const MeanDifference& difference, const Equivalence& equivalence, double level = 0.05);

/// Repeats of each side (equal numbers) that would settle with probability `power` whether the difference lies inside the margin, if it is what it seems to be
/// and the scatter stays (normal approximation); 0 when it lies within a hundredth of the margin's edge, where no number would.
int repeats_needed(const MeanDifference& difference, const Repeats& a, const Repeats& b, double margin, double level = 0.05, double power = 0.8);

}  // namespace pelletlab::inference
