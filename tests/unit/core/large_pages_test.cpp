#include "core/large_pages.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <thread>

#include "core/random.hpp"

namespace pelletlab {
namespace {

TEST(LargePages, PiecesAreAlignedLieApartAndKeepWhatIsWritten) {
    // All sizes near the borders of size classes, of a page, and of pieces that are mapped by themselves.
    std::map<unsigned char*, std::size_t> pieces;
    unsigned char mark = 0;
    for (std::size_t power = 1; power <= 22; ++power)
        for (const int off : {-1, 0, 1}) {
            const std::size_t bytes = (std::size_t{1} << power) + static_cast<std::size_t>(off);
            auto* piece = static_cast<unsigned char*>(take_memory(bytes));
            ASSERT_EQ(reinterpret_cast<std::uintptr_t>(piece) % 64, 0u) << bytes;
            std::memset(piece, mark++, bytes);
            pieces[piece] = bytes;
        }
    const unsigned char* end = nullptr;
    for (const auto& [piece, bytes] : pieces) {
        EXPECT_GE(piece, end);
        end = piece + bytes;
        for (std::size_t k = 0; k < bytes; k += 61) ASSERT_EQ(piece[k], piece[0]);
        ASSERT_EQ(piece[bytes - 1], piece[0]);
    }
    for (const auto& [piece, bytes] : pieces) give_memory(piece, bytes);
}

TEST(LargePages, WhatIsGivenBackServesTheNext) {
    // A thousand times one vector of growing length: without reuse that would be 1000 pieces, here few addresses come up.
    std::map<void*, int> seen;
    for (int k = 0; k < 1000; ++k) {
        LargeVector<double> v(100, 1.0);
        ++seen[v.data()];
    }
    EXPECT_LE(seen.size(), 2u);
}

TEST(LargePages, ThreadsTakeAndGiveAtOnce) {
    std::vector<std::thread> threads;
    std::vector<int> wrong(4, 0);
    for (std::size_t t = 0; t < 4; ++t)
        threads.emplace_back([t, &wrong] {
            RandomStream random(11, t);
            std::vector<LargeVector<std::uint64_t>> held(16);
            for (int k = 0; k < 4000; ++k) {
                auto& v = held[static_cast<std::size_t>(random.uniform() * 16.0)];
                for (const std::uint64_t x : v) wrong[t] += x != v.size() * 4 + t;
                const auto n = static_cast<std::size_t>(random.uniform() * 2000.0);
                LargeVector<std::uint64_t>(n, n * 4 + t).swap(v);
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (const int w : wrong) EXPECT_EQ(w, 0);
}

}  // namespace
}  // namespace pelletlab
