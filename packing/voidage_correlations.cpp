#include "packing/voidage_correlations.hpp"

#include <numbers>

#include "core/rigid_template.hpp"

namespace pelletlab::packing {

const std::vector<VoidageCorrelation>& voidage_correlations_of_cylinders() {
    static const std::vector<VoidageCorrelation> list{
        {"Dixon 1988", 0.0, 0.6, [](double s) { return 0.36 + 0.10 * s + 0.7 * s * s; }},
        {"Benyahia & O'Neill 2005", 1.0 / 26.3, 1.0 / 1.7, [](double s) { return 0.373 + 1.703 / ((1.0 / s + 0.611) * (1.0 / s + 0.611)); }}};
    return list;
}

std::vector<CorrelatedBed> correlated_beds(double count, double pellet_volume, double tube_diameter) {
    const double s = equivalent_diameter(pellet_volume) / tube_diameter;
    std::vector<CorrelatedBed> beds;
    for (const VoidageCorrelation& law : voidage_correlations_of_cylinders())
        if (s >= law.lowest && s <= law.highest)
            beds.push_back({law.name, law.voidage(s), bed_height_at_voidage(law.voidage(s), count, pellet_volume, tube_diameter)});
    return beds;
}

double bed_height_at_voidage(double voidage, double count, double pellet_volume, double tube_diameter) {
    return count * pellet_volume / (0.25 * std::numbers::pi * tube_diameter * tube_diameter * (1.0 - voidage));
}

}  // namespace pelletlab::packing
