#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

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

TEST(Parallel, ThrowsTheFirstOfSeveralExceptionsAndRunsAllBlocks) {
    set_thread_count(3);
    for (int repeat = 0; repeat < 50; ++repeat) {
        std::atomic<int> visits{0};
        std::string message;
        try {
            parallel_for(200, 1, [&](std::size_t i) {
                ++visits;
                if (i % 50 == 31) throw std::runtime_error(std::to_string(i));
            });
        } catch (const std::runtime_error& e) {
            message = e.what();
        }
        EXPECT_EQ(message, "31");
        EXPECT_EQ(visits, 200);
    }
    set_thread_count(0);
}

TEST(Parallel, ALoopInsideALoopVisitsEverything) {
    set_thread_count(3);
    std::vector<std::atomic<int>> visits(40 * 30);
    parallel_for(40, 1, [&](std::size_t i) { parallel_for(30, 1, [&](std::size_t k) { ++visits[i * 30 + k]; }); });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
    set_thread_count(0);
}

TEST(Parallel, TwoCallersAtATimeBothFinish) {
    set_thread_count(2);
    std::vector<double> sums(2, 0.0);
    const auto caller = [&](std::size_t which) {
        for (int repeat = 0; repeat < 300; ++repeat) {
            std::vector<double> parts(64, 0.0);
            parallel_for(parts.size(), 1, [&](std::size_t i) { parts[i] = static_cast<double>(i); });
            for (const double part : parts) sums[which] += part;
        }
    };
    std::thread other(caller, 1);
    caller(0);
    other.join();
    EXPECT_EQ(sums[0], 300.0 * 64 * 63 / 2);
    EXPECT_EQ(sums[1], sums[0]);
    set_thread_count(0);
}

TEST(Parallel, ManySmallLoopsWithPausesAreAllDone) {
    // Pauses longer than the team stays awake: threads fall asleep and must wake again.
    set_thread_count(4);
    std::atomic<long> total{0};
    for (int round = 0; round < 2000; ++round) {
        parallel_for(7, 1, [&](std::size_t i) { total += static_cast<long>(i); });
        if (round % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_EQ(total, 2000L * 21);
    set_thread_count(0);
}
