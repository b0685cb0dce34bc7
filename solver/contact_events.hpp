// Contact events: what every collision costs. An event is the time from the first touch of two bodies (or of a body and a wall) to their last, whatever number
// of their spheres touch meanwhile. Events are not kept one by one: they are sorted into spectra when they end.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pelletlab::solver {

/// The energies of an event [J]:
///   impact            ½ m* v_n², v_n the speed of approach at the deepest sphere contact in the first step of the event, along its normal;
///                     1/m* = 1/m_i + 1/m_j, with a wall m* = m_i; 0 when the bodies do not approach there
///   normal            what normal damping dissipates from first to last touch
///   total             normal + tangential damping + sliding + rolling friction of the same time
enum class EventEnergy : std::uint8_t { impact, normal, total };
inline constexpr std::size_t event_energies = 3;

/// Bins of equal width in log10 of the energy; an energy below the first bin counts in it, one above the last in the last.
inline constexpr double spectrum_lowest = 1e-12;  ///< [J]
inline constexpr std::size_t spectrum_bins_a_decade = 8, spectrum_bins = 12 * spectrum_bins_a_decade;

/// Lower edge of a bin [J]; of bin `spectrum_bins` the upper edge of the last.
double spectrum_edge(std::size_t bin);
std::size_t spectrum_bin(double energy);

struct EventSpectrum {
    std::array<double, spectrum_bins> count{};   ///< events
    std::array<double, spectrum_bins> energy{};  ///< [J], their sum
};

/// Of one kind: pellet–pellet, or pellet–one wall.
struct ContactEvents {
    std::array<EventSpectrum, event_energies> spectra{};
    double complete = 0.0;             ///< events that began and ended while they were recorded
    double duration = 0.0;             ///< [s], their sum
    double dissipated = 0.0;           ///< [J], all that the contacts of this kind dissipated while recorded, complete events or not
    double dissipated_complete = 0.0;  ///< [J], by complete events
};

}  // namespace pelletlab::solver
