// Published correlations for the mean voidage of solid cylinders poured into a tube.
#pragma once

#include <string>
#include <vector>

namespace pelletlab::packing {

/// ε against d_v / D: d_v the diameter of the sphere of equal volume, D the tube's inner diameter.
struct VoidageCorrelation {
    std::string name;             ///< «Dixon 1988»
    double lowest, highest;       ///< range of d_v / D that it was fitted in
    double (*voidage)(double s);  ///< s = d_v / D
};

/// Dixon 1988 (Can. J. Chem. Eng. 66, 705), full cylinders: ε = 0.36 + 0.10 s + 0.7 s², s ≤ 0.6.
/// Benyahia & O'Neill 2005 (Part. Sci. Technol. 23, 169), full cylinders: ε = 0.373 + 1.703 / (1/s + 0.611)², 1.7 ≤ 1/s ≤ 26.3.
const std::vector<VoidageCorrelation>& voidage_correlations_of_cylinders();

/// What those that hold for a tube say of a bed of `count` pellets of `pellet_volume` [m³] in it.
struct CorrelatedBed {
    std::string correlation;
    double voidage, height;  ///< [m]
};
std::vector<CorrelatedBed> correlated_beds(double count, double pellet_volume, double tube_diameter);

/// Height of a bed of `count` pellets of volume `pellet_volume` [m³] in a tube of diameter `tube_diameter` [m] at a voidage: N V / (π D²/4 · (1 − ε)) [m].
double bed_height_at_voidage(double voidage, double count, double pellet_volume, double tube_diameter);

}  // namespace pelletlab::packing
