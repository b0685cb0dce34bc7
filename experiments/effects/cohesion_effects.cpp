// C4, E1, E2, E4: attraction between pellets, or of pellets and walls. A case has one law of cohesion, so an effect needs a case without any.
#include "core/error.hpp"
#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

namespace {

void choose_cohesion(Case& c, const std::string& law) {
    if (c.physics.cohesion != "none")
        throw bad_input("the case has physics.cohesion = \"" + c.physics.cohesion + "\" already", "take this effect out, or the cohesion out of the case");
    c.physics.cohesion = law;
}

/// Rows of contacts with walls.
template <class Change>
void on_walls(Case& c, Change change) {
    for (auto& [name, row] : c.contacts)
        if (name != "pellet-pellet") change(row);
}

}  // namespace

std::vector<Effect> cohesion_effects() {
    return {
        {"C4",
         "sticky_walls",
         "pellets stick to the walls",
         "SJKR with the energy density a on walls only: F = a × contact area",
         "SJKR as in LIGGGHTS; range of this project",
         "contact",
         "kPa",
         30.0,
         false,
         {},
         {},
         "turn the empty vessel over slowly: do pellets hang?",
         [](Case& c, double a) {
             choose_cohesion(c, "sjkr");
             on_walls(c, [a](ContactParameters& row) { row.cohesion_energy_density = 1e3 * a; });
         },
         {}},
        {"E1",
         "capillary_bridges",
         "damp pellets",
         "liquid bridges of 0.001 mm³ with the surface tension a: F = 2πR a / (1 + 1.05 Ŝ + 2.5 Ŝ²), Ŝ = S √(R/V)",
         "Willett et al. 2000, Lian et al. 1993; water: 0.073 N/m",
         "environment",
         "N/m",
         0.0728,
         false,
         {},
         {},
         "dry a portion at 105 °C and rerun one speed",
         [](Case& c, double a) {
             choose_cohesion(c, "capillary");
             c.physics.liquid_surface_tension = a;
             c.physics.liquid_bridge_volume = 1e-12;
         },
         {}},
        {"E2",
         "charged_walls",
         "charged pellets stick to the walls",
         "a touching wall pulls with the force a; 0.12 mN is 0.3 of the weight of the study's pellet",
         "image charge: F = q²/(16 π ε₀ r²), about 1 nC on 5 mm",
         "environment",
         "mN",
         0.12,
         false,
         {},
         {},
         "antistatic spray, damp air",
         [](Case& c, double a) {
             choose_cohesion(c, "constant_force");
             on_walls(c, [a](ContactParameters& row) { row.attraction_force = 1e-3 * a; });
         },
         {}},
        {"E5",
         "cohesion",
         "pellets stick to each other and to the walls",
         "SJKR with the energy density a in all contacts: F = a × contact area",
         "SJKR as in LIGGGHTS; 30 kPa (kJ/m³): public drum factorial",
         "environment",
         "kPa",
         30.0,
         false,
         {},
         {},
         "dry a portion and rerun one speed",
         [](Case& c, double a) {
             choose_cohesion(c, "sjkr");
             for (auto& [name, row] : c.contacts) row.cohesion_energy_density = 1e3 * a;
         },
         {}},
    };
}

}  // namespace pelletlab::experiments::effects
