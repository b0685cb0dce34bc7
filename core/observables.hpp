// Measured numbers, the same for a simulation and for an experiment: each with unit, standard error, window and the method that made it.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/provenance.hpp"

namespace pelletlab {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

struct TimeWindow {
    double begin = 0.0;  ///< [s]
    double end = 0.0;    ///< [s]
};

struct Observable {
    std::string name;  ///< «bed_height_h95»
    std::string unit;  ///< of value and standard_error: «mm»
    double value = not_known;
    double standard_error = not_known;  ///< of the mean, time correlation included; NaN when one instant was measured
    TimeWindow window;
    std::string method;  ///< id of the definition, explained in docs/observables.md
};

/// A quantity along one coordinate.
struct Profile {
    std::string name, unit;
    std::string axis_name, axis_unit;
    std::vector<double> axis;   ///< bin centres, in axis_unit
    std::vector<double> value;  ///< NaN where nothing was seen
    std::vector<double> standard_error;
    TimeWindow window;
    std::string method;
};

/// A quantity on a regular grid over a plane; row-major, value[row · columns + column], row 0 at the lower edge.
struct FieldMap {
    std::string name, unit;
    std::string horizontal_axis, vertical_axis;  ///< «x», «z»
    double origin_horizontal = 0.0;              ///< [m], centre of the first cell
    double origin_vertical = 0.0;                ///< [m]
    double spacing = 0.0;                        ///< [m]
    std::size_t columns = 0, rows = 0;
    std::vector<double> value;  ///< NaN where nothing was seen
    std::vector<double> sample_count;
    TimeWindow window;
    std::string method;
};

struct Observables {
    std::string case_name;
    std::string status = "complete";  ///< «complete», «not at rest», «not steady»: what a reader must know before using a number
    std::vector<Observable> values;
    std::vector<Profile> profiles;
    std::vector<FieldMap> maps;
    Provenance provenance;
};

}  // namespace pelletlab
