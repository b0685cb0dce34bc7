// Numbers out, text in: what all writers share.
#pragma once

#include <string>

#include "shapegen/formats/formats.hpp"

namespace pelletlab::shapegen::formats::detail {

/// The shortest text that reads back as the same double; «-0» becomes «0».
std::string exact(double value);

/// Plain decimal notation with that many digits after the point, trailing zeros cut: no exponent.
std::string plain(double value, int decimals);

/// Units of an export: the options' or the format's usual ones.
struct Units {
    std::string length, mass;
    double metre = 1.0;     ///< one unit of length in metres
    double kilogram = 1.0;  ///< one unit of mass in kilograms

    double in_length(double metres) const { return metres / metre; }
    double in_mass(double kilograms) const { return kilograms / kilogram; }
    double in_volume(double value) const { return value / (metre * metre * metre); }
    double in_inertia(double value) const { return value / (kilogram * metre * metre); }
};

/// Throws Error(bad_input) for an unknown unit.
Units units_for(const WriteOptions& options, const std::string& usual_length, const std::string& usual_mass);

/// Throws Error(bad_input) unless the template has spheres of positive radius and a positive mass, volume and inertia, all finite.
void require_complete(const ClumpTemplate& clump);

/// The template's name in letters, digits, '_' only (it becomes file names and identifiers); «pellet» when nothing is left.
std::string safe_name(const ClumpTemplate& clump);

/// «PelletLab clump: name pellet, length in mm, mass in kg, density 1800 kg/m^3»: readers find the units in it.
std::string header_line(const ClumpTemplate& clump, const Units& units);

}  // namespace pelletlab::shapegen::formats::detail
