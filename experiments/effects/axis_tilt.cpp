// B4: the drum's axis is not level. In the drum's frame gravity leans along the axis: g' = (g_x, g_y cos a + g_z sin a, g_z cos a − g_y sin a), a from 0 to 2
// degrees.
#include <cmath>
#include <numbers>

#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

Effect axis_tilt() {
    return {"B4",
            "axis_tilt",
            "the drum's axis is not level",
            "gravity turned by a about x, so that the bed leans on one end plate",
            "spirit level; range of this project",
            "boundary",
            "deg",
            2.0,
            false,
            {},
            {Rig::drum},
            "spirit level; gradient of the bed along the axis",
            [](Case& c, double a) { c.gravity = Eigen::AngleAxisd(a * std::numbers::pi / 180.0, Vec3::UnitX()) * c.gravity; },
            {}};
}

}  // namespace pelletlab::experiments::effects
