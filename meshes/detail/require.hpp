// Checks of makers' arguments, with one wording.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "core/error.hpp"

namespace pelletlab::meshes::detail {

inline void require_positive(double value, const char* what) {
    if (!(value > 0.0) || !std::isfinite(value))
        throw bad_input(std::string("the ") + what + " of a mesh must be a positive length, but it is " + std::to_string(value) + " m",
                        "give a positive value");
}

inline void require_facets(std::uint32_t facets, std::uint32_t least = 3) {
    if (facets < least || facets > 1000000)
        throw bad_input("a round mesh needs between " + std::to_string(least) + " and 1000000 facets, but " + std::to_string(facets) + " were asked for",
                        "use 96 for a smooth wall");
}

}  // namespace pelletlab::meshes::detail
