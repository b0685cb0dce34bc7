// Forces on bodies that are neither gravity nor contact.
#pragma once

#include "core/vec.hpp"

namespace pelletlab::solver {

/// Still air: on the sphere of the body's volume, diameter d, with Re = ρ |v| d / η,
///   F = −3 π η d v (1 + 0.15 Re^0.687) up to Re = 1000, −0.44 (π/8) ρ d² |v| v above (Schiller & Naumann 1935),  T = −π η d³ ω.
struct StillAir {
    double density = 0.0;       ///< ρ [kg/m³]; 0: no air
    double viscosity = 1.8e-5;  ///< η [Pa s]
};

struct BodyForces {
    StillAir air;
    Vec3 attraction = Vec3::Zero();  ///< [m/s²], a uniform field beside gravity; its work is booked, it has no potential in the books

    bool any() const { return air.density > 0.0 || attraction != Vec3::Zero(); }
};

}  // namespace pelletlab::solver
