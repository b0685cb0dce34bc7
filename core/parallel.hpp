// The only header of this house that knows threads: a team that lives as long as the program (thread_team.hpp).
// Work is cut into blocks of a fixed size that does not depend on the number of threads, and reductions fold the blocks in order:
// the same bits come out for any thread count.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace pelletlab {

/// Threads used by everything below; 0 means «as many as the machine has». Call it before work starts.
void set_thread_count(int count);
int thread_count();

/// Calls body(begin, end) once for each block [k·grain, min((k+1)·grain, n)); blocks run in any order and side by side.
/// An exception thrown by a block is rethrown here after all blocks have ended; of several, that of the first block. A call from inside a block runs in the
/// thread at hand.
void parallel_blocks(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(i) for every i in [0, n).
template <class Body>
void parallel_for(std::size_t n, std::size_t grain, const Body& body) {
    parallel_blocks(n, grain, [&body](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Fold of block results in block order: combine(…combine(combine(zero, block 0), block 1)…).
template <class Value, class Block, class Combine>
Value parallel_reduce(std::size_t n, std::size_t grain, Value zero, const Block& block_value, const Combine& combine) {
    if (n == 0) return zero;
    std::vector<Value> partial((n + grain - 1) / grain, zero);
    parallel_blocks(n, grain, [&](std::size_t begin, std::size_t end) { partial[begin / grain] = block_value(begin, end); });
    Value total = zero;
    for (const Value& part : partial) total = combine(total, part);
    return total;
}

}  // namespace pelletlab
