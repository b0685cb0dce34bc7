#include "core/large_pages.hpp"

#include <bit>
#include <cstdint>
#include <mutex>
#include <new>

#if defined(__SANITIZE_ADDRESS__)
#define PELLETLAB_ORDINARY_MEMORY
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PELLETLAB_ORDINARY_MEMORY
#endif
#endif
#if !defined(__linux__) && !defined(PELLETLAB_ORDINARY_MEMORY)
#define PELLETLAB_ORDINARY_MEMORY
#endif

#ifndef PELLETLAB_ORDINARY_MEMORY
#include <sys/mman.h>
#endif

namespace pelletlab {

namespace {

constexpr std::size_t line = 64;

#ifndef PELLETLAB_ORDINARY_MEMORY

constexpr std::size_t large_page = std::size_t{1} << 21, page = 4096;
constexpr std::size_t by_itself = std::size_t{1} << 19;  ///< pieces of that size and more are mapped one by one

std::size_t rounded(std::size_t bytes, std::size_t unit) {
    return (bytes + unit - 1) / unit * unit;
}

/// Whole pages that begin at a multiple of a large page.
void* map(std::size_t bytes) {
    const std::size_t wanted = rounded(bytes, page), taken = wanted + large_page;
    void* const all = mmap(nullptr, taken, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (all == MAP_FAILED) throw std::bad_alloc();
    char* const first = static_cast<char*>(all);
    const std::size_t head = (large_page - reinterpret_cast<std::uintptr_t>(first) % large_page) % large_page;
    if (head > 0) munmap(first, head);
    munmap(first + head + wanted, taken - head - wanted);
    madvise(first + head, wanted, MADV_HUGEPAGE);  // a system without large pages says no, which does no harm
    return first + head;
}

/// Four sizes an octave. From 4 kB on an odd number of lines more: columns of the same length would otherwise all fall on the same lines of the caches.
struct SizeClass {
    std::size_t index, bytes;
};

SizeClass class_of(std::size_t bytes) {
    const std::size_t lines = (bytes + line - 1) / line;
    if (lines <= 4) return {lines, lines * line};
    const auto octave = static_cast<std::size_t>(std::bit_width(lines - 1)) - 3;  // lines − 1 in [4, 8) · 2^octave
    const std::size_t steps = (lines - 1) >> octave;
    const std::size_t size = (steps + 1) << octave;
    return {5 + 4 * octave + (steps - 4), (size + (size >= 64 ? 3 : 0)) * line};
}

/// Pieces cut from large pages; what is given back serves the next of its size.
class Pool {
public:
    void* take(SizeClass size) {
        const std::lock_guard lock(mutex_);
        Free*& free = free_[size.index];
        if (free) {
            Free* const piece = free;
            free = piece->next;
            return piece;
        }
        if (size.bytes > left_) {
            rest_ = static_cast<char*>(map(2 * large_page));
            left_ = 2 * large_page;
        }
        char* const piece = rest_;
        rest_ += size.bytes;
        left_ -= size.bytes;
        return piece;
    }
    void give(void* memory, SizeClass size) noexcept {
        const std::lock_guard lock(mutex_);
        free_[size.index] = new (memory) Free{free_[size.index]};
    }

private:
    struct Free {
        Free* next;
    };
    std::mutex mutex_;
    char* rest_ = nullptr;
    std::size_t left_ = 0;
    Free* free_[64] = {};
};

Pool& pool() {
    static Pool& all = *new Pool;  // outlives every static object that may hold memory of it
    return all;
}

#endif

}  // namespace

void* take_memory(std::size_t bytes) {
#ifdef PELLETLAB_ORDINARY_MEMORY
    return ::operator new (bytes, std::align_val_t{line});
#else
    if (bytes >= by_itself) return map(bytes);
    return pool().take(class_of(bytes == 0 ? 1 : bytes));
#endif
}

void give_memory(void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef PELLETLAB_ORDINARY_MEMORY
    ::operator delete (memory, std::align_val_t{line});
#else
    if (bytes >= by_itself)
        munmap(memory, rounded(bytes, page));
    else
        pool().give(memory, class_of(bytes == 0 ? 1 : bytes));
#endif
}

}  // namespace pelletlab
