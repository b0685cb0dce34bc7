// Damping of a Hertz contact that never pulls, so that it returns with the wanted restitution.
#pragma once

namespace pelletlab::solver::detail {

/// α of F = max(0, k d^(3/2) + α sqrt(m* k) d^(1/4) d') for which a normal impact at any speed returns with `restitution` (> 0): found by integrating
/// the impact and bisection, to 1e-9. EDEM's −sqrt(5) ln e / sqrt(ln² e + π²) gives it only when the contact may pull.
double damping_without_tension(double restitution);

}  // namespace pelletlab::solver::detail
