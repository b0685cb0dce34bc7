// Charts of what measurement operators found: profiles of a bed in a tube, energies of collisions. Nothing where the numbers they show are not there.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/chart.hpp"

namespace pelletlab::report {

/// A mean porosity to compare with: «Dixon 1988, mean of cylinders», 0.44. Drawn as a broken level line.
using NamedLevel = std::pair<std::string, double>;

/// Porosity in rings against the distance from the wall in pellet diameters, with the core's mean (profile packing_fraction_radial, values
/// mean_equivalent_diameter and packing_fraction_core_clipped of measure_tube_bed). `radius` [m], of the tube.
std::optional<Chart> porosity_from_wall(const Observables& bed, double radius, const std::vector<NamedLevel>& levels);
/// Porosity in slices against the height [mm] (profile packing_fraction_axial).
std::optional<Chart> porosity_over_height(const Observables& bed);
/// Mean |axis · vertical| and |axis · radius| in rings against the distance from the axis [mm], ± one standard error; ½ is what random orientations have.
std::optional<Chart> orientation_over_radius(const Observables& bed);
/// Density of contact forces over their mean, logarithmic (profile contact_force_distribution).
std::optional<Chart> contact_forces(const Observables& bed);
/// Events per pellet and second in bins of 1/8 decade of an energy, both axes logarithmic, one line a kind of contact (profiles spectrum_<energy>_…).
/// `energy`: «impact_energy», «normal_dissipation» or «total_dissipation».
std::optional<Chart> collision_spectrum(const Observables& tester, const std::string& energy);

}  // namespace pelletlab::report
