#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

using namespace pelletlab;

TEST(Parallel, VisitsEveryIndexOnce) {
    std::vector<std::atomic<int>> visits(1003);
    parallel_for(visits.size(), 10, [&](std::size_t i) { ++visits[i]; });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
}

TEST(Parallel, SumHasTheSameBitsForAnyThreadCount) {
    const auto sum = [] {
        return parallel_reduce(
            100000, 64, 0.0,
            [](std::size_t begin, std::size_t end) {
                double part = 0.0;
                for (std::size_t i = begin; i < end; ++i) part += std::sin(static_cast<double>(i)) / static_cast<double>(i + 1);
                return part;
            },
            [](double a, double b) { return a + b; });
    };
    set_thread_count(1);
    const double one = sum();
    for (const int threads : {2, 3, 8}) {
        set_thread_count(threads);
        for (int repeat = 0; repeat < 5; ++repeat) EXPECT_EQ(sum(), one) << threads;
    }
    set_thread_count(0);
}

TEST(Parallel, RethrowsWhatABlockThrows) {
    set_thread_count(2);
    EXPECT_THROW(parallel_for(100, 1,
                              [](std::size_t i) {
                                  if (i == 57) throw std::runtime_error("57");
                              }),
                 std::runtime_error);
    set_thread_count(0);
}
