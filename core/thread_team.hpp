// A team of threads that waits awake for a moment between pieces of work: a time step of a small bed has five parallel loops in a fifth of a millisecond,
// and waking a sleeping thread for each of them costs more than the loop. Used by parallel.cpp only.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace pelletlab {

class ThreadTeam {
public:
    using Work = void (*)(const void* context, std::size_t block);

    /// A team of `size` threads, the caller of run() included.
    explicit ThreadTeam(std::size_t size);
    ~ThreadTeam();
    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;

    std::size_t size() const { return shares_.size(); }

    /// Calls work(context, block) once for each block in [0, blocks). Every thread begins with its own part of the blocks, the same part each time (what it
    /// touched is still in its cache), and helps the others when it is through. Of the exceptions of several blocks that of the first block is thrown.
    void run(std::size_t blocks, Work work, const void* context);

    /// True for a moment after the system took a helper off its core while it held a block of a short loop, so that all waited for it: on a crowded machine
    /// working alone is faster.
    bool better_alone() const;

private:
    /// Blocks that nobody has taken yet: begin in the low half, end in the high half. The owner takes from the front, helpers from the back.
    struct alignas(64) Share {
        std::atomic<std::uint64_t> range{0};
    };

    std::vector<Share> shares_;
    std::vector<std::thread> threads_;
    // Written by run() while the work is closed and no thread is inside.
    Work work_ = nullptr;
    const void* context_ = nullptr;
    alignas(64) std::atomic<std::uint32_t> round_{0};  ///< counts calls of run(); threads sleep on it
    alignas(64) std::atomic<bool> open_{false};
    std::atomic<bool> ends_{false};
    alignas(64) std::atomic<std::uint32_t> inside_{0};  ///< helpers that may touch the work

    std::chrono::steady_clock::time_point alone_until_{};

    std::mutex failure_mutex_;
    std::exception_ptr failure_;
    std::size_t failed_block_ = 0;

    void help(std::size_t member);
    void wait_for_helpers(std::chrono::steady_clock::time_point start);
    void take_part(std::size_t member);
    void do_block(std::size_t block);
    std::uint32_t wait_for_round_after(std::uint32_t seen) const;
};

}  // namespace pelletlab
