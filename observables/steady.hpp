// When did a run become steady? A change from a transient to a stationary series, found from the series itself.
#pragma once

#include <cstddef>
#include <span>

#include "core/observables.hpp"
#include "core/trajectory.hpp"

namespace pelletlab::observables {

struct SteadyOnset {
    bool found = false;           ///< false: fewer than 20 values, or the best cut lies in the later half, so that the series is too short to tell
    double index = 0.0;           ///< first value of the stationary part
    double standard_error = 0.0;  ///< of index
};

/// MSER (marginal standard error rule; White 1997, Simulation 69:323; key white1997): the cut d that minimises Σ_{k ≥ d} (y_k − ȳ_d)² / (n − d)², the squared
/// standard error of the mean of what is left. At least five values are left; the earliest of equal cuts wins. Its error is the standard deviation of the
/// cut over 100 series with the same course (a running mean over five values before the cut, the mean behind it) and residuals of the stationary part
/// in random blocks, so that their correlation is kept (moving blocks of n^(1/3) values; Künsch 1989, key kunsch1989). Same bits for the same seed.
SteadyOnset steady_onset(std::span<const double> series, std::uint64_t seed);

/// «steady_onset_time» [s] of a drum from the time when it begins to turn (the first stored change of a wall's pose; the first frame when there are no
/// walls): steady_onset of the angle of the bed's centre of mass below the axis, brought to even steps of time. The value is NaN when it is not found.
Observable drum_steady_onset(const FrameSource& trajectory);

}  // namespace pelletlab::observables
