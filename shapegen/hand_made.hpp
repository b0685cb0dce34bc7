// The study's hand-made Shapes 1–4 for its 3.12 × 2.96 mm cylinder (Marigo & Stitt 2015, table 2), centres by our layout A: the article gives counts and radii
// only.
#pragma once

#include <vector>

#include "core/rigid_template.hpp"

namespace pelletlab::shapegen {

/// number 1 … 4; spheres in the frame of the cylinder (axis z, centre in the origin) [m]. Throws Error(usage) otherwise.
std::vector<Sphere> hand_made_shape(int number);

}  // namespace pelletlab::shapegen
