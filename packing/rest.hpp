// When pellets count as at rest: hardly any kinetic energy, and the same contacts for a while.
#pragma once

#include <array>
#include <string>

#include "core/case.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::packing {

/// At rest: for 0.02 s the kinetic energy per pellet stays below time.rest_kinetic_energy · m g d (m, d: mass and equivalent diameter of the first template)
/// and the number of touching pairs within time.rest_contact_change of what it was at the beginning of that while. Not at rest in time is a result with a
/// status, not an error.
class RestRule {
public:
    static constexpr std::size_t memory_size = 2;
    static constexpr std::array<double, memory_size> start{-1.0, 0.0};  ///< quiet since [s] (negative: it is not), touching pairs then

    RestRule(const Case& c, const solver::Simulation& simulation);
    /// To be asked in the order of time; `memory` begins as `start` and is kept from call to call.
    bool holds(const solver::Simulation& now, double* memory);
    /// For Progress::note.
    std::string note() const;

private:
    double kinetic_limit_ = 0.0, contact_change_ = 0.0, scale_ = 0.0, relative_energy_ = 0.0;
};

}  // namespace pelletlab::packing
