#include "solver/detail/pair_contacts.hpp"

#include "solver/detail/aligned_scratch.hpp"

namespace pelletlab::solver::detail {

void pair_contact_forces(PairList& list, std::size_t block_index, const LargeVector<Kinematic>& kinematics, const std::vector<BodyTemplate>& templates,
                         const std::vector<const Ball*>& balls, const LawRow& law, ContactKernel contact, const Kernels& kernels, const StepClock& clock) {
    thread_local PairScratchStorage scratch;  // both hold nothing between calls
    thread_local BatchStorage storage;
    PairBlock& block = list.blocks[block_index];
    const std::size_t begin = block.pair_begin, count = block.pair_end - block.pair_begin;
    scratch.reserve(count);
    PairBlockView view{list.records.data() + begin,
                       count,
                       block.body_begin,
                       block.body_end,
                       kinematics.data(),
                       balls.data(),
                       block.candidates.data(),
                       block.springs.data(),
                       list.spring_rows,
                       &list.books[block_index],
                       list.pair_books.empty() ? nullptr : list.pair_books.data() + begin,
                       list.loads_j.data() + begin,
                       list.touching.data() + begin,
                       list.own_loads.data(),
                       list.own_touching.data()};
    kernels.find_poses(view, scratch.scratch);
    std::size_t candidates = 0;
    std::uint32_t listed = 0;
    const bool seek_generous = (clock.index + block_index) % 32 == 0;  // not every step: it means reading all records once more
    for (std::size_t k = 0; k < count; ++k) {
        if (scratch.scratch.stale[k] || (seek_generous && too_generous(list.records[begin + k], list.pair_skin, clock.index))) {
            PairRecord& record = list.records[begin + k];
            refresh_candidates(list, block, record, templates[record.template_i], templates[record.template_j],
                               relative_pose(kinematics[record.i], kinematics[record.j]), kernels, clock.index);
            scratch.scratch.counts[k] = record.count;
        }
        candidates += scratch.scratch.counts[k];
        scratch.scratch.listed[listed] = static_cast<std::uint32_t>(k);  // without a branch: half of the pairs have candidates
        listed += scratch.scratch.counts[k] > 0 ? 1u : 0u;
    }
    scratch.scratch.listed_count = listed;
    view.candidates = block.candidates.data();
    view.springs = block.springs.data();
    storage.batch.size = 0;
    storage.reserve(candidates, law.booked);
    (law.reach > 0.0 ? kernels.sticky_pair_forces : kernels.pair_forces)(contact, law, view, scratch.scratch, storage.batch, clock);
}

}  // namespace pelletlab::solver::detail
