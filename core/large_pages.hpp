// Memory for what a program walks through again and again. Ordinary pages are 4 kB, and a processor remembers where only about 12 MB of them lie: beyond that
// every jump costs a walk through the page table. Here memory comes in pieces of 2 MB that the system may map as one page (Linux: MADV_HUGEPAGE; elsewhere
// and under address sanitizers it is ordinary memory).
#pragma once

#include <cstddef>
#include <vector>

namespace pelletlab {

/// Memory of at least that size, at a multiple of 64. Throws std::bad_alloc. Safe to call from several threads.
void* take_memory(std::size_t bytes);
/// Gives back what take_memory(bytes) returned. Small pieces are kept for the next that asks, large ones go back to the system.
void give_memory(void* memory, std::size_t bytes) noexcept;

template <class T>
struct LargePageAllocator {
    using value_type = T;
    LargePageAllocator() = default;
    template <class Other>
    LargePageAllocator(const LargePageAllocator<Other>&) {}  // NOLINT: allocators convert

    T* allocate(std::size_t n) { return static_cast<T*>(take_memory(n * sizeof(T))); }
    void deallocate(T* memory, std::size_t n) noexcept { give_memory(memory, n * sizeof(T)); }
    template <class Other>
    bool operator==(const LargePageAllocator<Other>&) const {
        return true;
    }
};

template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace pelletlab
