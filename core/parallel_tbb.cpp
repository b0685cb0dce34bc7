#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <memory>

#include "core/parallel.hpp"

namespace pelletlab {

namespace {
std::unique_ptr<tbb::global_control> limit;
int chosen_count = 0;
}  // namespace

void set_thread_count(int count) {
    chosen_count = std::max(0, count);
    limit.reset();
    if (chosen_count > 0) limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(chosen_count));
}

int thread_count() {
    return chosen_count > 0 ? chosen_count : tbb::info::default_concurrency();
}

void parallel_blocks(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t block_count = (n + grain - 1) / grain;
    const auto run_block = [&](std::size_t block) { body(block * grain, std::min(n, (block + 1) * grain)); };
    if (block_count <= 1 || thread_count() == 1) {
        for (std::size_t block = 0; block < block_count; ++block) run_block(block);
        return;
    }
    tbb::parallel_for(std::size_t{0}, block_count, run_block);
}

}  // namespace pelletlab
