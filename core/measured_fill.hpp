// A filled tube as a laboratory reports it.
#pragma once

#include <limits>

namespace pelletlab {

struct MeasuredFill {
    double pellets = 0.0;                                         ///< in the tube; 0: not stated
    double mass = 0.0;                                            ///< [kg], of all pellets; 0: not stated
    double height = 0.0;                                          ///< [m], mean of the repeats
    double deviation = std::numeric_limits<double>::quiet_NaN();  ///< [m], standard deviation (n − 1) of the repeats; NaN: one repeat
    int repeats = 0;
    int line = 0;  ///< of the file, of its first row
};

}  // namespace pelletlab
