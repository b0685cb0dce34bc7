// Counter-based random numbers: the value depends on (seed, stream, counter) alone, so results do not depend on threads or order.
// Philox4x32-10: Salmon, Moraes, Dror, Shaw (2011), "Parallel random numbers: as easy as 1, 2, 3", SC'11.
#pragma once

#include <array>
#include <cstdint>

#include "core/vec.hpp"

namespace pelletlab {

/// The raw generator: 128 random bits from a 128-bit counter and a 64-bit key.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// A stream of numbers: give every independent use (a pellet, a purpose) a stream of its own.
class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

    std::uint64_t bits();                        ///< 64 uniform bits
    double uniform();                            ///< [0, 1)
    double uniform(double lower, double upper);  ///< [lower, upper)
    double normal();                             ///< mean 0, standard deviation 1 (Box–Muller)
    Quat rotation();                             ///< uniform over all orientations (Shoemake 1992)

private:
    std::uint64_t seed_;
    std::uint64_t stream_;
    std::uint64_t counter_ = 0;
};

}  // namespace pelletlab
