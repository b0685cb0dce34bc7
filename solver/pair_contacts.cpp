#include "solver/detail/pair_contacts.hpp"

#include <algorithm>
#include <memory>

#include "solver/detail/aligned_scratch.hpp"

namespace pelletlab::solver::detail {

void pair_contact_forces(PairList& list, std::size_t block_index, const std::vector<Kinematic>& kinematics, const std::vector<BodyTemplate>& templates,
                         const std::vector<const Ball*>& balls, const LawRow& law, const Kernels& kernels, const StepClock& clock) {
    thread_local const auto scratch = std::make_unique<PairScratch>();  // holds nothing between calls
    thread_local BatchStorage storage;
    PairBlock& block = list.blocks[block_index];
    const std::size_t begin = block_index * pairs_per_block, count = std::min(pairs_per_block, list.records.size() - begin);
    PairBlockView view{list.records.data() + begin, count,
                       kinematics.data(),           balls.data(),
                       block.candidates.data(),     block.springs.data(),
                       list.loads_i.data() + begin, list.loads_j.data() + begin,
                       list.touching.data() + begin};
    kernels.find_poses(view, *scratch);
    std::size_t candidates = 0;
    for (std::size_t k = 0; k < count; ++k) {
        PairRecord& record = list.records[begin + k];
        if (scratch->stale[k])
            refresh_candidates(block, record, templates[record.template_i], templates[record.template_j],
                               relative_pose(kinematics[record.i], kinematics[record.j]), list.pair_skin);
        candidates += record.count;
    }
    view.candidates = block.candidates.data();
    view.springs = block.springs.data();
    storage.batch.size = 0;
    storage.reserve(candidates);
    kernels.pair_forces(law, view, *scratch, storage.batch, clock);
}

}  // namespace pelletlab::solver::detail
