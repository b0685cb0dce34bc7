// Contact forces between bodies: one call works through the pairs of one block.
#pragma once

#include <vector>

#include "solver/detail/kernels.hpp"
#include "solver/detail/pair_list.hpp"

namespace pelletlab::solver::detail {

/// What every contact of a step shares.
struct StepClock {
    double spring_step = 0.0;  ///< [s], over which tangential springs grow; 0 when forces are only looked at
    double step = 0.0;         ///< [s]
};

/// Rolling friction of one contact may stop at most this share of a body's spin in a step (a body has rarely more than eight neighbours).
inline constexpr double rolling_share = 1.0 / 8.0;

/// Refreshes stale candidate lists of the block, finds the touching spheres, computes their forces and writes loads and touching flags.
void pair_contact_forces(PairList& list, std::size_t block, const std::vector<Kinematic>& kinematics, const Bodies& bodies,
                         const std::vector<BodyTemplate>& templates, const LawRow& law, const Kernels& kernels, const StepClock& clock);

}  // namespace pelletlab::solver::detail
