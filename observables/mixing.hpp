// How well two halves of a bed have mixed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab::observables {

/// Index of Lacey (1954, J. Appl. Chem. 4:257; key lacey1954) over cubic cells of side `cell`, for cells of unequal content:
/// M = (S₀² − S²) / (S₀² − S_r²) with S² = Σ n_i (p_i − p)² / N, S₀² = p (1 − p) of a state unmixed in every cell, and S_r² = p (1 − p) (K − 1)/(N − 1), the
/// mean of S² when N pellets are dealt at random into the K cells that hold any. 0 unmixed, 1 as mixed as at random (a little above by chance). Places that are
/// NaN are left out. NaN when one of the labels is missing or fewer than two cells are filled.
double lacey_index(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& label, double cell);

}  // namespace pelletlab::observables
