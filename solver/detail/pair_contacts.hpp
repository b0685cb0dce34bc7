// Contact forces between bodies: one call works through the pairs of one block.
#pragma once

#include <vector>

#include "solver/detail/kernels.hpp"
#include "solver/detail/pair_list.hpp"

namespace pelletlab::solver::detail {

/// Refreshes stale candidate lists of the block, finds the touching spheres, computes their forces and writes loads and touching flags.
void pair_contact_forces(PairList& list, std::size_t block, const LargeVector<Kinematic>& kinematics, const std::vector<BodyTemplate>& templates,
                         const std::vector<const Ball*>& balls, const LawRow& law, ContactKernel contact, const Kernels& kernels, const StepClock& clock);

}  // namespace pelletlab::solver::detail
