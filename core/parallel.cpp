#include "core/parallel.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>

#include "core/thread_limit.hpp"
#include "core/thread_team.hpp"

namespace pelletlab {

namespace {

int chosen_count = 0;
std::mutex team_mutex;  ///< held while the team works
std::unique_ptr<ThreadTeam> team;
thread_local bool inside_a_block = false;

using Body = std::function<void(std::size_t, std::size_t)>;

struct Loop {
    std::size_t n, grain;
    const Body& body;
    void run_block(std::size_t block) const { body(block * grain, std::min(n, (block + 1) * grain)); }
};

void run_in_team(const void* context, std::size_t block) {
    struct Inside {
        Inside() { inside_a_block = true; }
        ~Inside() { inside_a_block = false; }
    } inside;
    static_cast<const Loop*>(context)->run_block(block);
}

}  // namespace

void set_thread_count(int count) {
    const std::lock_guard lock(team_mutex);
    chosen_count = std::max(0, count);
    team.reset();
    limit_library_threads(chosen_count);
}

int thread_count() {
    static const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));  // asking takes a system call
    return chosen_count > 0 ? chosen_count : all;
}

void parallel_blocks(std::size_t n, std::size_t grain, const Body& body) {
    const Loop loop{n, grain, body};
    const std::size_t blocks = (n + grain - 1) / grain;
    const auto members = static_cast<std::size_t>(thread_count());
    // A loop inside a loop, and one of a second caller while the team is busy, run in the thread at hand.
    std::unique_lock lock(team_mutex, std::defer_lock);
    if (blocks <= 1 || members == 1 || inside_a_block || !lock.try_lock()) {
        for (std::size_t block = 0; block < blocks; ++block) loop.run_block(block);
        return;
    }
    if (!team || team->size() != members) {
        team.reset();
        team = std::make_unique<ThreadTeam>(members);
    }
    if (team->better_alone()) {
        for (std::size_t block = 0; block < blocks; ++block) run_in_team(&loop, block);
        return;
    }
    team->run(blocks, &run_in_team, &loop);
}

}  // namespace pelletlab
