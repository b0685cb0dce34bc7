// Follows contacts from first to last touch; lives beside the contacts and touches nothing that decides the future.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/contact_events.hpp"
#include "solver/detail/kernels.hpp"

namespace pelletlab::solver::detail {

/// One contact that goes on. Times in steps.
struct OpenEvent {
    std::uint64_t key = 0;             ///< ids of the two bodies, or the body's
    std::uint64_t since = 0;           ///< step of the first touch; 0: nothing touches
    double impact = -1.0;              ///< [J]; negative: it had begun before it was recorded
    double normal = 0.0, total = 0.0;  ///< [J]
    bool goes_on() const { return since != 0; }
};

struct ContactRecorder {
    std::uint64_t started = 0;                  ///< step; 0: not recording
    std::vector<ContactEvents> kinds;           ///< pellet–pellet, then walls in their order
    std::vector<OpenEvent> pairs;               ///< one a pair record
    std::vector<std::vector<OpenEvent>> walls;  ///< per wall, one a body by its id
    std::uint64_t seen_rebuilds = 0;            ///< of the pair list that `pairs` belongs to
    std::vector<OpenEvent> ended;               ///< scratch
};

class CheckpointWriter;
class CheckpointReader;
void put_recorder(CheckpointWriter& writer, const ContactRecorder& recorder);
/// Throws Error(bad_input) for what no recorder of so many walls, steps and bodies can hold.
ContactRecorder get_recorder(CheckpointReader& reader, std::size_t wall_count, std::uint64_t steps, std::size_t bodies);

}  // namespace pelletlab::solver::detail
