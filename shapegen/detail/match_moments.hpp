// Last touch of the fit: the union gets the body's volume, centre of mass and principal inertia by a common radius offset, a shift and a slight
// stretch of the centres.
#pragma once

#include <vector>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen::detail {

struct BodyMoments {
    double volume = 0.0;
    Vec3 centre = Vec3::Zero();
    Mat3 covariance = Mat3::Zero();  ///< ∫ (x − centre)(x − centre)ᵀ dV / volume
};

struct MatchSettings {
    bool volume = true;
    bool centre_and_inertia = true;
    double min_radius = 0.0;
    double largest_stretch = 0.002;  ///< |stretch| of the centres along any principal axis; few spheres cannot have the body's inertia
};

/// Spheres are changed in place. Newton steps on the exact moments of the union with a Jacobian by differences; where the stretch meets its limit the
/// inertia stays off, while the volume is always met (as far as the minimum radius lets it).
void match_moments(std::vector<Sphere>& spheres, const BodyMoments& body, const MatchSettings& settings);

}  // namespace pelletlab::shapegen::detail
