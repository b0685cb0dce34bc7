// How far the gap shrinks, and whether runs of the campaign themselves (not the emulator) speak for a second effect.
#pragma once

#include "core/diagnosis.hpp"
#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

/// G² = mean of ((y − m)² − σ²)/t², σ² the measurement's variance, t the tolerance. Before: «parameters only»; after: hypothesis `leading`; placebo: the most
/// probable single effect that `leading` does not contain. Both fitted to the same data; rows for fitted and held-out data; 90 % intervals over posterior draws
/// and measurement noise drawn once more, whose variances are taken off each squared miss of a draw too, so that the interval lies about the value.
std::vector<DiagnosisShrink> quantify(const Attributor& attributor, const Attribution& attribution, int leading, std::uint64_t seed);

/// Campaign runs with both effects against runs with one of them, each at its best (on a segment between two of the dozen nearest runs), on the fitted data
/// whitened at the pair's mode: the pair must be better by 9 + 2 ln(number of pair runs / number of single runs). False when the campaign has no run with both.
bool runs_confirm_pair(const Attributor& attributor, const Attribution& attribution, const Eigen::VectorXd& y, int pair_hypothesis);

/// Shrink on a data set (fitted or held out) by single runs of the campaign: the run closest to the fitted data in the block of `leading` against the closest
/// baseline run. NaN where no such runs exist.
double shrink_by_runs(const Attributor& attributor, const Attribution& attribution, int leading, bool held_out);

}  // namespace pelletlab::diagnosis
