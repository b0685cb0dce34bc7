#include "core/thread_team.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace pelletlab {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::microseconds awake{200};        ///< how long a thread without work waits before it sleeps
constexpr std::chrono::microseconds short_loop{2000};  ///< loops of time steps; longer ones may have long blocks, for which waiting is no sign of anything
constexpr std::chrono::microseconds long_wait{1000};   ///< longer than a block of a short loop takes
constexpr std::chrono::milliseconds most_alone{50};

inline void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

constexpr std::uint64_t pack(std::uint64_t begin, std::uint64_t end) {
    return begin | (end << 32);
}

/// Takes one block off a share. False when it is empty.
bool take(std::atomic<std::uint64_t>& range, bool front, std::size_t& block) {
    std::uint64_t old = range.load(std::memory_order_relaxed);
    for (;;) {
        const std::uint64_t begin = old & 0xffffffffu, end = old >> 32;
        if (begin >= end) return false;
        const std::uint64_t rest = front ? pack(begin + 1, end) : pack(begin, end - 1);
        if (range.compare_exchange_weak(old, rest, std::memory_order_relaxed)) {
            block = static_cast<std::size_t>(front ? begin : end - 1);
            return true;
        }
    }
}

}  // namespace

ThreadTeam::ThreadTeam(std::size_t size) : shares_(size) {
    for (std::size_t member = 1; member < size; ++member) threads_.emplace_back([this, member] { help(member); });
}

ThreadTeam::~ThreadTeam() {
    ends_.store(true);
    round_.fetch_add(1);
    round_.notify_all();
    for (std::thread& t : threads_) t.join();
}

void ThreadTeam::run(std::size_t blocks, Work work, const void* context) {
    const std::size_t members = size();
    work_ = work;
    context_ = context;
    failure_ = nullptr;
    failed_block_ = std::numeric_limits<std::size_t>::max();
    for (std::size_t m = 0; m < members; ++m) shares_[m].range.store(pack(m * blocks / members, (m + 1) * blocks / members), std::memory_order_relaxed);
    const auto start = Clock::now();
    open_.store(true);
    round_.fetch_add(1);
    round_.notify_all();
    take_part(0);
    // All blocks are taken. Nobody enters any more once the work is closed; who is inside still holds a block, or sees that there is none.
    open_.store(false);
    if (inside_.load() != 0) wait_for_helpers(start);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadTeam::wait_for_helpers(Clock::time_point start) {
    const auto waiting_since = Clock::now();
    while (inside_.load() != 0) {
        for (int spins = 0; inside_.load() != 0 && spins < 64; ++spins) pause();
        if (Clock::now() - waiting_since > long_wait) std::this_thread::sleep_for(std::chrono::microseconds(50));  // gives the core away, perhaps to the helper
    }
    const auto end = Clock::now();
    if (waiting_since - start < short_loop && end - waiting_since > long_wait)
        alone_until_ = end + std::min<Clock::duration>(5 * (end - waiting_since), most_alone);
}

bool ThreadTeam::better_alone() const {
    return alone_until_ > Clock::time_point{} && Clock::now() < alone_until_;
}

void ThreadTeam::take_part(std::size_t member) {
    const std::size_t members = size();
    std::size_t block = 0;
    while (take(shares_[member].range, true, block)) do_block(block);
    for (std::size_t step = 1; step < members; ++step) {
        Share& other = shares_[(member + step) % members];
        while (take(other.range, false, block)) do_block(block);
    }
}

void ThreadTeam::do_block(std::size_t block) {
    try {
        work_(context_, block);
    } catch (...) {
        const std::lock_guard lock(failure_mutex_);
        if (block < failed_block_) failed_block_ = block, failure_ = std::current_exception();
    }
}

std::uint32_t ThreadTeam::wait_for_round_after(std::uint32_t seen) const {
    std::uint32_t now = round_.load();
    for (unsigned spins = 1; now == seen && spins <= 256; ++spins, now = round_.load()) pause();
    const auto start = Clock::now();
    while (now == seen && Clock::now() - start < awake) {
        for (int spins = 0; now == seen && spins < 64; ++spins, now = round_.load()) pause();
    }
    while (now == seen) {
        round_.wait(seen);
        now = round_.load();
    }
    return now;
}

void ThreadTeam::help(std::size_t member) {
    for (std::uint32_t seen = 0; !ends_.load();) {
        // Enter first and look then: run() closes first and then waits until nobody is inside.
        inside_.fetch_add(1);
        if (open_.load()) take_part(member);
        inside_.fetch_sub(1);
        seen = wait_for_round_after(seen);
    }
}

}  // namespace pelletlab
