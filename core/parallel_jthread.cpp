// Plain threads, for ThreadSanitizer: Debian's oneTBB is not instrumented and gives false reports.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "core/parallel.hpp"

namespace pelletlab {

namespace {
std::atomic<int> chosen_count{0};
}

void set_thread_count(int count) {
    chosen_count = std::max(0, count);
}

int thread_count() {
    return chosen_count > 0 ? chosen_count.load() : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_blocks(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t block_count = (n + grain - 1) / grain;
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        for (std::size_t block = next++; block < block_count; block = next++) {
            try {
                body(block * grain, std::min(n, (block + 1) * grain));
            } catch (...) {
                const std::lock_guard lock(failure_mutex);
                if (!failure) failure = std::current_exception();
            }
        }
    };
    const std::size_t helpers = std::min<std::size_t>(block_count, static_cast<std::size_t>(thread_count()));
    {
        std::vector<std::jthread> threads;
        for (std::size_t i = 1; i < helpers; ++i) threads.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace pelletlab
