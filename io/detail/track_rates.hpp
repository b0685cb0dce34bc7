// Velocities and spins of tracks from their places and orientations.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/vec.hpp"

namespace pelletlab::io::detail {

struct TrackedRow {
    double time = 0.0;  ///< [s]
    std::uint32_t body = 0;
    int line = 0;                                                              ///< of the file
    Vec3 position = Vec3::Zero();                                              ///< [m]
    Vec3 velocity = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< [m/s]
    Vec3 spin = Vec3::Zero();                                                  ///< [rad/s]
    Quat orientation = Quat::Identity();
};

struct RateSettings {
    double largest_gap = 0.0;  ///< [s]; 0: 2.5 times the median step of all tracks
    bool velocities = true;    ///< take them from the places
    bool spins = false;        ///< take them from the orientations
};

struct RateCounts {
    std::size_t without_velocity = 0;
    std::size_t missing = 0;  ///< observations that the gaps lack, a gap of n usual steps lacking n − 1
};

/// Rows in the order of time. With neighbours at −h₁ and +h₂ the velocity is that of the parabola through the three,
/// v = ((x₊ − x₀) h₁² + (x₀ − x₋) h₂²) / (h₁ h₂ (h₁ + h₂)), error of order h²; with one neighbour (x₊ − x₀)/h₂, error of order h; with none NaN.
/// The spin is the rotation vector from the one neighbour's orientation to the other's, divided by their distance in time.
RateCounts add_rates(std::vector<TrackedRow>& rows, std::size_t bodies, const RateSettings& settings);

}  // namespace pelletlab::io::detail
